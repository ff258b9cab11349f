"""Programs in the words of machines: dialects as data, and one writer for all of them."""
