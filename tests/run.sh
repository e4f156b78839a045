#!/usr/bin/env bash
# Sets up a Debian 12 machine, builds everything and runs the tests; one verdict at the end. The build is that of
# examples/run.sh. --long: also the tests labelled long, and half an hour of fuzzing in place of half a minute.
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
fuzzing=$([ -n "$long" ] && echo 1800 || echo 30)

install_packages build pictures report tests
parts "building all=9" "tests=7"
[ -z "$long" ] || parts "long tests=30"
parts "the report's page in a browser=1" "the API reference, every warning an error=1" \
      "fuzzing the readers of scenes and robots=$((3 + fuzzing / 60))"

part "building all" build_release -DOSGTSS_TESTS=ON "${later_parts[@]/%/=ON}"
[ -d ../shared/meshes ] || say "../shared/meshes is absent: tests on real meshes say 'skipped, no meshes'"

in_browser() {
    install_packages browser || echo "chromium cannot be installed here"
    tests/report/page.sh build/bin/tss
}
api() {
    install_packages api
    cmake --preset release >/dev/null # which looks for doxygen again
    cmake --build --preset release --target api
}
fuzz() {
    install_packages fuzz
    tests/fuzz/run.sh "$fuzzing"
}

keep_going
part "tests" ctest --preset release
[ -z "$long" ] || part "long tests" ctest --test-dir build -L long --output-on-failure
part "the report's page in a browser" in_browser
part "the API reference, every warning an error" api
part "fuzzing the readers of scenes and robots" fuzz
verdict
