"""The literature's schemes for taut paths, over the same kernels as `meshwind.path`, for comparison with it."""

from meshwind.methods.driver import run
from meshwind.methods.frequency import largest_frequency, stable_step
from meshwind.methods.motion import Ending, History, Method, Motion

__all__ = ["Ending", "History", "Method", "Motion", "largest_frequency", "run", "stable_step"]
