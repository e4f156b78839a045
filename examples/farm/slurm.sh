#!/usr/bin/env bash
# Bakes the pairs of a scene as a Slurm job array, one pair a task, and merges the parts in a job that waits for them.
# The result has the same bytes as `tss bake SCENE -o OUT OPTIONS` in one go.
# usage: examples/farm/slurm.sh SCENE.tss OUT.tss [options of tss bake]
# All nodes must see this folder and that of OUT. Prints the number of the last job.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '4p' "$0" >&2; exit 2; }
tss=$(realpath "${TSS:-$(dirname "$0")/../../build/bin/tss}")
scene=$(realpath "$1") out=$(realpath -m "$2")
shift 2
parts=$(mktemp -d -p "$(dirname "$out")" parts.XXXXXX)
"$tss" info "$scene" --paths >"$parts/pairs"

# As the shell of a task reads them.
quoted() { [ $# -eq 0 ] || printf '%q ' "$@"; }
task="cd $(quoted "$parts")
pair=\$(sed -n \"\${SLURM_ARRAY_TASK_ID}p\" pairs)
exec $(quoted "$tss" bake "$scene") -o \$SLURM_ARRAY_TASK_ID.tss --pair \"\$pair\" --threads 1 --quiet $(quoted "$@")"
array=$(printf '#!/bin/bash\n%s\n' "$task" |
    sbatch --parsable --array "1-$(wc -l <"$parts/pairs")" --cpus-per-task 1 --output "$parts/%a.log")
merge="cd $(quoted "$parts") && $(quoted "$tss" merge "$scene") ./*.tss -o $(quoted "$out") && rm -r $(quoted "$parts")"
printf '#!/bin/bash\n%s\n' "$merge" |
    sbatch --parsable --dependency "afterok:$array" --output "$parts.log"
