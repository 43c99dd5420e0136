"""Runs the program of this package: `python3 -m corcast`."""
import os
import pathlib
import sys

program = pathlib.Path(__file__).resolve().parent / "bin" / "corcast"
os.execv(program, ["corcast", *sys.argv[1:]])
