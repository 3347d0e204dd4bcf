#!/usr/bin/env bash
# Packs the program of one target with its documents, and writes the checksum next to the archive.
# Usage: pack.sh TARGET VERSION FOLDER
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$1
version=$2
out=$3

name="carom-v$version-$target"
folder="target/pack/$name"
program=carom
case $target in *windows*) program=carom.exe ;; esac
rm -rf "$folder"
mkdir -p "$folder" "$out"
cp "target/$target/release/$program" LICENSE README.md CHANGELOG.md "$folder"
if [ -d target/documents ]; then
    cp -r target/documents/* "$folder"
fi
case $target in
*windows*)
    archive="$name.zip"
    (cd target/pack && python3 -m zipfile -c "../../$out/$archive" "$name")
    ;;
*)
    archive="$name.tar.gz"
    tar -C target/pack -czf "$out/$archive" "$name"
    ;;
esac
(cd "$out" && { command -v sha256sum > /dev/null && sha256sum "$archive" || shasum -a 256 "$archive"; } > "$archive.sha256")
echo "$out/$archive"
