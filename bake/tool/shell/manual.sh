#!/usr/bin/env bash
# Manual pages of tss and of each of its subcommands, made of what they say of themselves (help2man).
# usage: manual.sh TSS FOLDER VERSION
set -euo pipefail
tss=$1 folder=$2 version=$3
mkdir -p "$folder"
cd "$(dirname "$tss")"
page() { help2man --no-info --name "$1" --version-string "$version" "./${*:2}" > "$folder/$(tr ' ' - <<< "${*:2}").1"; }

page "$(./tss --help | head -n 1)" tss
./tss --help | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]*\) .*/\1/p}' | while read -r name; do
    page "$(./tss "$name" --help | head -n 1)" tss "$name" < /dev/null
done
