# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Usage: bash completion.bash PROGRAM SOURCE. Checks what bash and zsh offer after the start of a
# command.
set -euo pipefail
program=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
touch film.toml film.h5 notes.txt

expect() { # SHELL, what is offered in one line, WORD...
  local shell=$1 wanted=$2 offered
  shift 2
  offered=$("offered_by_$shell" "$@" | sort | tr '\n' ' ')
  [ "$offered" = "$wanted " ] || {
    echo "$shell: after 'cayspin $*': '$offered', not '$wanted'" >&2
    exit 1
  }
}
offered_by_bash() {
  bash -c 'source "$1"; COMP_WORDS=("${@:2}"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _cayspin
           printf "%s\n" "${COMPREPLY[@]}"' - "$source/cayspin.bash" "$program" "$@"
}
# zsh defines compadd, _files and _describe only while a user types. These stand-ins print the
# completions.
offered_by_zsh() {
  zsh -fc 'compadd() { shift; print -l -- $@ }; _files() { print -l -- *.(toml|h5) }
           _describe() { print -l -- ${${(P)2}%%:*} }
           words=("${@:2}") CURRENT=$(($# - 1)) PREFIX=$words[-1]; source "$1"' \
    - "$source/_cayspin" "$program" "$@"
}

expect bash "relax reproduce run" r
expect bash "--help --json --precision --ranks --set" check --
expect bash "--ranks --restart" run --r
expect bash "film.toml" run ""
expect bash "film.h5" info f
expect bash "double single" check film.toml --precision ""
expect bash "chain crystal" new c
if command -v zsh >/dev/null; then
  [ "$(offered_by_zsh "" | sort)" = "$(offered_by_bash "" | grep -v -- -- | sort)" ]
  expect zsh "--help --json --precision --ranks --set" check --
  expect zsh "double single" check film.toml --precision ""
  expect zsh "bodies chain crystal film standard_problem" new ""
  expect zsh "film.h5 film.toml" run ""
else
  echo "zsh is not installed: its completion was not tried"
fi
