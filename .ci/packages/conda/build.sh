#!/bin/sh
# conda sets CC, CFLAGS, CPPFLAGS, LDFLAGS, PREFIX, SP_DIR and CPU_COUNT.
set -eu
make -j"${CPU_COUNT:-2}" all lib PREFIX="$PREFIX"
make install PREFIX="$PREFIX" PYTHONDIR="${SP_DIR:-$PREFIX/lib/python3/dist-packages}"
