#!/usr/bin/env bash
# Writes what packages hold besides the program: manual pages and completions, from the program itself, and the licences of
# what it is made of. It needs python3.
# Use: documents.sh PROGRAM FOLDER
set -euo pipefail
program=$1
folder=$2

rm -rf "$folder"
mkdir -p "$folder/man" "$folder/completions"
"$program" man > "$folder/man/carom.1"
# The commands stand in the help between "Commands:" and the next empty line.
commands=$("$program" --help | sed -n '/^Commands:/,/^$/p' | awk '/^  [a-z]/ && $1 != "help" { print $1 }')
for command in $commands; do
    "$program" man "$command" > "$folder/man/carom-$command.1"
done
"$program" completions bash > "$folder/completions/carom.bash"
"$program" completions zsh > "$folder/completions/_carom"
"$program" completions fish > "$folder/completions/carom.fish"
"$program" completions powershell > "$folder/completions/carom.ps1"
python3 .github/scripts/licences.py > "$folder/LICENCES.txt"
