"""The charts of `speed_accuracy.py` and `stability.py`, one module a chart over one harness."""
