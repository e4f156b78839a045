#!/usr/bin/env bash
# The manual page of a program and of each of its subcommands, made of what they say of themselves (help2man).
# usage: manual.sh PROGRAM FOLDER VERSION
set -euo pipefail
program=$1 folder=$2 version=$3
mkdir -p "$folder"
cd "$(dirname "$program")"
name=$(basename "$program")
# usage: page SENTENCE PROGRAM [SUBCOMMAND]: named PROGRAM-SUBCOMMAND, as man looks for it.
page() {
    local words="${*:2}"
    local title=${words// /-}
    help2man --no-info --name "$1" --version-string "$version" "./$words" |
        sed "s/^\.TH [^ ]*/.TH ${title^^}/; s/^$words \\\\-/$title \\\\-/" | gzip -9n > "$folder/$title.1.gz"
}

page "$("./$name" --help | head -n 1)" "$name"
"./$name" --help | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]*\) .*/\1/p}' | while read -r subcommand; do
    page "$("./$name" "$subcommand" --help | head -n 1)" "$name" "$subcommand" < /dev/null
done
