#!/usr/bin/env bash
# Lines and branches of the library, the node kit and the tools that the tests reach: a table by folder, and
# build-coverage/coverage.html with every line. Branches are those written in the source: what the compiler adds
# for exceptions is left out. Counting is not atomic, which would take tens of times as long: each test has a core
# of its own, where its threads take turns.
# usage: tests/coverage.sh [TESTS...], names as in ctest (geometry, table, ...; all when none is given).
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/setup.sh
packages_coverage=(gcovr)
install_packages build pictures report tests coverage

cmake --preset coverage
targets=()
for test in "$@"; do targets+=(--target "test_$test"); done
cmake --build --preset coverage --parallel "$(nproc)" "${targets[@]}"
find build-coverage -name '*.gcda' -delete
failed=
names=$(IFS='|'; echo "$*")
ctest --preset coverage --show-only --tests-regex "^(${names:-.*})$" | sed -n 's/^ *Test *#[0-9]*: //p' |
    parallel --jobs "$(nproc)" --line-buffer --joblog build-coverage/tests.log \
        "taskset --cpu-list \$(({%} - 1)) ctest --preset coverage --tests-regex '^{}$'" || failed=yes

say "Coverage"
gcovr --root . --object-directory build-coverage --filter bake/ --filter osgTSS/ --exclude-throw-branches \
    --exclude-unreachable-branches --gcov-ignore-parse-errors -j "$(nproc)" \
    --csv build-coverage/coverage.csv --html-details build-coverage/coverage.html
printf '| folder | lines | reached | branches | reached |\n|---|---|---|---|---|\n'
awk -F, 'NR > 1 {
    folder = $1; sub("/[^/]*$", "", folder)
    for (f in both) delete both[f]
    both[folder]; both["all"]
    for (f in both) { l[f] += $2; lc[f] += $3; b[f] += $5; bc[f] += $6 }
} END {
    for (f in l) printf "| %s | %d | %.1f %% | %d | %.1f %% |\n", f, l[f], 100 * lc[f] / (l[f] ? l[f] : 1),
        b[f], 100 * bc[f] / (b[f] ? b[f] : 1)
}' build-coverage/coverage.csv | sort
[ -z "$failed" ] || { say "Some tests failed"; exit 1; }
