"""The literature's schemes for taut paths, over the same kernels as `meshwind.path`: what it is compared with."""

from meshwind.methods.driver import run
from meshwind.methods.frequency import largest_frequency, stable_step
from meshwind.methods.run import Ending, History, Method, Run

__all__ = ["Ending", "History", "Method", "Run", "largest_frequency", "run", "stable_step"]
