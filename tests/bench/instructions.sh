#!/usr/bin/env bash
# Instructions a query, pose features given (but for "pose", which makes them where needed), by callgrind: the
# difference between two runs of bench_queries that differ by a million queries alone; what Highway does as it starts
# differs by up to two million from run to run. usage: tests/bench/instructions.sh BUILD [KERNEL...]   (needs valgrind)
set -euo pipefail
program=$1/bin/bench_queries
shift
kernels=("${@:-avx2}")

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : *//p'
}
reached() {
    local few many
    few=$(instructions "$@" 2048)
    many=$(instructions "$@" 1002048)
    echo $(((many - few + 500000) / 1000000))
}

printf '| kernel | pairs | motion | asked | instructions | goal |\n|---|---|---|---|---|---|\n'
for kernel in "${kernels[@]}"; do
    while read -r pairs motion with goal; do
        # The goals are those of vectors of 256 bits.
        [ "$kernel" = avx2 ] || goal=
        printf '| %s | %s | %s | %s | %s | %s |\n' "$kernel" "$pairs" "$motion" "$with" \
            "$(reached "$motion" "$pairs" "$kernel" "$with")" "$goal"
    done <<END
22 hinge hit 50
22 hinge-slide hit 75
22 two-hinges hit 75
22 general hit 110
22 hinge gap 105
22 general gap 160
22 hinge contact 240
22 hinge-slide contact 240
22 two-hinges contact 240
22 general contact 240
268 hinge hit 300
268 hinge-slide hit 380
268 two-hinges hit 520
268 general hit 700
268 hinge pose
268 hinge-slide pose
268 two-hinges pose
268 general pose
22 hinge features
22 hinge-slide features
22 two-hinges features
22 general features
END
done
