"""Any triangle mesh to a clean annulus: read, repair, choose the ends, trim."""
