"""The device as compiled functions, and its working cycle simulated with them."""

from tvimdesign.base.environment import ask_for_one_thread

ask_for_one_thread()  # before CasADi loads its libraries
