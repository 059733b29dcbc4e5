# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Completion of cayspin for bash: commands, options and kinds come from its own --help.
_cayspin() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} program=${COMP_WORDS[0]}
  local IFS=$'\n' words pattern help
  help=$("$program" ${COMP_CWORD:+${COMP_WORDS[1]}} --help 2>/dev/null </dev/null)
  if ((COMP_CWORD == 1)); then
    words=$("$program" --help | sed -n '/^Compute:/,$ s/^  \([a-z]*\).*/\1/p')$'\n--help\n--version'
  elif [[ $word == -* ]]; then
    words=$(grep -oE -- '--[a-z][a-z-]*' <<<"$help")
  elif [[ $before == --precision ]]; then
    words=$'double\nsingle'
  elif ((COMP_CWORD == 2)) && [[ ${COMP_WORDS[1]} == new ]]; then
    words=$(sed -n 's/^  KIND .*REQUIRED *//p' <<<"$help" | tr -d ' ' | tr , '\n')
  else
    [[ $help == *HDF5* ]] && pattern='*.h5'
    [[ $help == *'(TOML)'* && $before != --output && $before != --restart ]] && pattern='*.toml'
    COMPREPLY=($(compgen -f -X "!${pattern:-*}" -- "$word"; compgen -d -S / -- "$word"))
    compopt -o nospace -o filenames 2>/dev/null
    return
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -F _cayspin cayspin
