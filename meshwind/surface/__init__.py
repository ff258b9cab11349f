"""The smooth surface: one tensor B-spline type, fitted or analytic."""
