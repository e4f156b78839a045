#!/usr/bin/env bash
# Sets up a Debian 12 machine, builds everything and runs the tests. --long: also those labelled long,
# and half an hour of fuzzing in place of half a minute.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/setup.sh

long=
for argument in "$@"; do
    case "$argument" in
    --long) long=yes ;;
    *)
        echo "usage: tests/run.sh [--long]" >&2
        exit 2
        ;;
    esac
done

install_packages
build_release
[ -d ../shared/meshes ] || say "../shared/meshes is absent: tests on real meshes say 'skipped, no meshes'"

say "Tests"
ctest --preset release
if [ -n "$long" ]; then
    say "Long tests"
    ctest --test-dir build -L long --output-on-failure
fi

say "The API reference, every warning an error"
cmake --build --preset release --target api

say "Fuzzing the readers of scenes and robots"
tests/fuzz/run.sh "$([ -n "$long" ] && echo 1800 || echo 30)"
