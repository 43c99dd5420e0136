"""Runs the program of this package: `corcast` and `python3 -m corcast`."""
import os
import pathlib
import sys


def main():
    program = pathlib.Path(__file__).resolve().parent / "bin" / "corcast"
    os.execv(program, ["corcast", *sys.argv[1:]])


if __name__ == "__main__":
    main()
