"""`python -m tvimdesign` is `tvimdesign`."""

from tvimdesign.cli.main import main

main()
