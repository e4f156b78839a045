#!/usr/bin/env bash
# The manual page of a program and of each of its subcommands, made of what they say of themselves (help2man).
# usage: manual.sh PROGRAM FOLDER VERSION
set -euo pipefail
program=$1 folder=$2 version=$3
mkdir -p "$folder"
cd "$(dirname "$program")"
name=$(basename "$program")
page() {
    help2man --no-info --name "$1" --version-string "$version" "./${*:2}" | gzip -9n > "$folder/$(tr ' ' - <<< "${*:2}").1.gz"
}

page "$("./$name" --help | head -n 1)" "$name"
"./$name" --help | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]*\) .*/\1/p}' | while read -r subcommand; do
    page "$("./$name" "$subcommand" --help | head -n 1)" "$name" "$subcommand" < /dev/null
done
