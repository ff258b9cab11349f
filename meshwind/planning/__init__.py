"""Planning of paths: families and pins, the number of revolutions, and the spacing of neighbours."""
