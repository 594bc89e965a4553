"""Runs a module of this package as a child: `python -m tvimdesign.base.run_child MODULE [ARGUMENT...]`.

The child asks to end with its parent before the module is imported, which takes seconds where it draws or solves.
"""

from __future__ import annotations

import runpy
import sys

from tvimdesign.base.child_process import follow_parent


def main() -> None:
    """Follow the parent, then be the module."""
    follow_parent()
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
