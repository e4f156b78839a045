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

install_packages build pictures report tests
say "Building the preset release into build/"
build_release -DOSGTSS_TESTS=ON -DOSGTSS_REPORT=ON
[ -d ../shared/meshes ] || say "../shared/meshes is absent: tests on real meshes say 'skipped, no meshes'"

passed=() failed=()
# part <name> <command>...: runs it, and goes on to the next part whatever comes of it.
part() {
    local name=$1
    shift
    say "$name"
    if "$@"; then passed+=("$name"); else failed+=("$name"); fi
}

part "Tests" ctest --preset release
[ -z "$long" ] || part "Long tests" ctest --test-dir build -L long --output-on-failure
part "API reference, every warning an error" cmake --build --preset release --target api
part "Fuzzing the scene reader" tests/fuzz/run.sh "$([ -n "$long" ] && echo 1800 || echo 30)"

say "Verdict"
for name in "${passed[@]}"; do echo "passed: $name"; done
for name in "${failed[@]}"; do echo "FAILED: $name"; done
echo "${#passed[@]} passed, ${#failed[@]} failed"
[ ${#failed[@]} -eq 0 ]
