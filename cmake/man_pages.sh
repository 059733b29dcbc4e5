#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Usage: man_pages.sh HELP2MAN PROGRAM FOLDER
set -euo pipefail
help2man=$1 program=$2 folder=$3
mkdir -p "$folder"
page() { # NAME DESCRIPTION COMMAND...
  "$help2man" --no-info --section 1 --version-string "$("$program" --version)" --name "$2" \
    --output "$folder/$1.1" "${*:3}"
}
while read -r command description; do
  page "cayspin-$command" "$description" "$program" "$command"
done < <("$program" --help | sed -n '/^Subcommands:/,$ s/^  \([a-z]\)/\1/p')
page cayspin "Lie-group time integration of spin fields" "$program"
