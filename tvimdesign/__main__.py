"""`python -m tvimdesign` is `tvimdesign`."""

from tvimdesign.cli import main

main()
