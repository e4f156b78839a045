#!/usr/bin/env bash
# Makes docs/REPORT.md and its plots in docs/report/ anew, from `tss report` on the repository's dog scenes; options
# go to it (--quick). Needs build/bin/tss, as tests/run.sh builds it. Takes some minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
scenes=(dog_jaw dog_frontalis)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for scene in "${scenes[@]}"; do
    LD_LIBRARY_PATH="$PWD/build/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" \
        build/bin/tss report "scenes/$scene.tss" -o "$work/$scene" --beside-paper "$@"
done

rm -rf docs/report
{
    printf '# The report on the dog scenes\n\n'
    printf 'Made by `bash docs/report.sh%s` from `tss report` on %s.\n' "${*:+ $*}" \
        "$(printf 'scenes/%s.tss ' "${scenes[@]}" | sed 's/ $//; s/ / and /')"
    printf 'The same command makes a report on any scene: `tss report scene.tss -o folder`.\n\n'
    for scene in "${scenes[@]}"; do
        mkdir -p "docs/report/$scene"
        cp "$work/$scene"/plots/*.svg "docs/report/$scene/"
        # One document: headings a level down, the plots where they are now, the licence once.
        sed -e '/^## Licence/,$d' -e 's/^#/##/' -e "s|](plots/|](report/$scene/|" "$work/$scene/report.md"
    done
    sed -n '/^## Licence/,$p' "$work/${scenes[0]}/report.md"
} >"$work/REPORT.md"
mv "$work/REPORT.md" docs/REPORT.md
