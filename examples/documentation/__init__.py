"""Tables and figures of README and the site, made from the results of the scripts that are kept."""
