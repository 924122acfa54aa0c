"""python -m deltalux: the command line, which the package brings along."""

import os
import sys
from pathlib import Path

program = Path(__file__).with_name("bin") / "deltalux"
os.execv(program, ["deltalux", *sys.argv[1:]])
