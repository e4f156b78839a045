#!/usr/bin/env bash
# run.sh TSS FOLDER: each scene of the repository as .usda, read by three's USDAParser and by tinyusdz, whose pinned
# npm packages go into FOLDER. Exit 77, which CTest takes as skipped, where npm is missing or reaches no network.
set -euo pipefail
tss=$1 folder=$2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cp "$here"/package.json "$here"/package-lock.json "$here"/read.mjs "$folder"
cd "$folder"
if ! command -v npm >/dev/null || ! npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1; then
    echo "skipped: no npm, or no network for it"
    exit 77
fi
files=()
for scene in "$here"/../../scenes/*.tss "$here"/instances.tss; do
    name=$(basename "$scene" .tss)
    "$tss" convert "$scene" "$name.tss" --quiet
    "$tss" convert "$scene" "$name.usda" --quiet
    files+=("$name.tss" "$name.usda")
done
node read.mjs "${files[@]}"
