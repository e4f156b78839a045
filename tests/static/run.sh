#!/usr/bin/env bash
# Builds the project beside this script, which holds osgTSS and its plugins in one program, and runs it where it finds no
# plugin of ours. Arguments: a folder to build in, a scene with a table.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 scene=$2
mkdir -p "$work"
cmake -S "$here" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=Release >"$work/configure.log"
cmake --build "$work" --target static_player >"$work/build.log" || { tail -40 "$work/build.log"; exit 1; }
player=$(find "$work" -name static_player -type f)
if ldd "$player" | grep -i osgtss; then
    echo "$player loads osgTSS from a file"
    exit 1
fi
cd "$work"
unset LD_LIBRARY_PATH
OSG_LIBRARY_PATH=/nonexistent "$player" "$scene"
