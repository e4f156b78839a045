# Completion of tss in bash: subcommands and options as the program itself lists them, else files.
_tss() {
    local word=${COMP_WORDS[COMP_CWORD]} list=
    if [ "$COMP_CWORD" -eq 1 ]; then
        list=$("$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]*\) .*/\1/p}')
    elif [[ $word == -* ]]; then
        list=$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE -- '--[a-z-]+')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$list" -- "$word")
}
complete -o default -F _tss tss
