#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Usage: man_pages.sh HELP2MAN PROGRAM FOLDER
set -euo pipefail
help2man=$1 folder=$3
program=$(basename "$2")
# help2man passes its argument to a shell, which would split a path with spaces.
PATH=$(cd "$(dirname "$2")" && pwd):$PATH
mkdir -p "$folder"
page() { # NAME DESCRIPTION COMMAND...
  "$help2man" --no-info --section 1 --version-string "$("$program" --version)" --name "$2" \
    --output "$folder/$1.1" "${*:3}"
}
# Each command stands in a line of its own, under the heading of its group.
while read -r command description; do
  # `reproduce`, `plot` and `view` may lack what they need even for --help.
  "$program" "$command" --help >/dev/null 2>&1 || continue
  page "cayspin-$command" "$description" "$program" "$command"
done < <("$program" --help | sed -n 's/^  \([a-z]\)/\1/p')
page cayspin "Lie-group time integration of spin fields" "$program"
