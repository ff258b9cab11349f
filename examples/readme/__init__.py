"""README's tables and figures, made from the results of the scripts that are kept."""
