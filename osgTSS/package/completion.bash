# Completion of tss and tss-render in bash: subcommands and options as the programs themselves list them, else files.
_tss() {
    local word=${COMP_WORDS[COMP_CWORD]} list= subcommand=()
    if [ "${1##*/}" = tss ] && [ "$COMP_CWORD" -gt 1 ]; then subcommand=("${COMP_WORDS[1]}"); fi
    if [[ $word == -* ]]; then
        list=$("$1" "${subcommand[@]}" --help 2>/dev/null | grep -oE -- '--[a-z-]+')
    elif [ "$COMP_CWORD" -eq 1 ]; then
        list=$("$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]*\) .*/\1/p}')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$list" -- "$word")
}
complete -o default -F _tss tss tss-render
