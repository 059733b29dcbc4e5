# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Usage: bash man_pages.bash SCRIPT HELP2MAN PROGRAM WORK. Checks that the program and each command
# have a manual page, also if the program's folder has a space in its name.
set -euo pipefail
script=$1 help2man=$2 program=$3 work=$4
rm -rf "$work"
mkdir -p "$work/with a space"
ln -s "$program" "$work/with a space/cayspin"
bash "$script" "$help2man" "$work/with a space/cayspin" "$work/man"
for page in cayspin cayspin-{run,relax,modes,path,sweep,check,new,trade,advise,methods,info,export}; do
  grep -q '^\.SH OPTIONS\|^\.SS "Options:"' "$work/man/$page.1" || {
    echo "$page.1: there is no such page, or it has no options" >&2
    exit 1
  }
done
