#!/bin/sh
# Installs the newest release of carom for this user: downloads the archive for this machine, verifies it, and copies the program to
# ~/.local/bin, or to the folder in CAROM_BIN. It changes nothing else.
set -eu

# The release workflow inserts the repository here.
repository=${CAROM_REPOSITORY:-@REPOSITORY@}
version=${CAROM_VERSION:-latest}
folder=${CAROM_BIN:-$HOME/.local/bin}

fail() {
    echo "carom is not installed: $1" >&2
    exit 1
}

case $repository in *@*) fail "CAROM_REPOSITORY does not name the repository, like OWNER/carom" ;; esac
case "$(uname -s)-$(uname -m)" in
Linux-x86_64) target=x86_64-unknown-linux-musl ;;
Linux-aarch64 | Linux-arm64) target=aarch64-unknown-linux-musl ;;
Darwin-x86_64) target=x86_64-apple-darwin ;;
Darwin-arm64) target=aarch64-apple-darwin ;;
*) fail "there is no program for $(uname -s) on $(uname -m); build it from source" ;;
esac
command -v curl > /dev/null || fail "curl is needed to download it"

server=${CAROM_SERVER:-https://github.com}
if [ "$version" = latest ]; then
    # The newest release redirects to the address of its page, which ends with its version.
    page=$(curl -fsSLI -o /dev/null -w '%{url_effective}' "$server/$repository/releases/latest") || fail "the newest release cannot be found"
    version=${page##*/v}
fi
name="carom-v$version-$target"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
for file in "$name.tar.gz" "$name.tar.gz.sha256"; do
    curl -fsSL -o "$place/$file" "$server/$repository/releases/download/v$version/$file" || fail "$file cannot be downloaded"
done
cd "$place"
if command -v sha256sum > /dev/null; then
    sha256sum -c "$name.tar.gz.sha256" > /dev/null || fail "the archive is not what was released"
else
    shasum -a 256 -c "$name.tar.gz.sha256" > /dev/null || fail "the archive is not what was released"
fi
tar -xzf "$name.tar.gz"
mkdir -p "$folder" || fail "the folder $folder cannot be made"
cp "$name/carom" "$folder/carom.new" || fail "nothing can be written to $folder"
chmod 755 "$folder/carom.new"
mv "$folder/carom.new" "$folder/carom"
echo "installed: $folder/carom, $("$folder/carom" --version)"
case ":$PATH:" in
*":$folder:"*) ;;
*) echo "add $folder to PATH to call it by its name" ;;
esac
