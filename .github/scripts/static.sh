#!/usr/bin/env bash
# Builds static programs for Linux and packs them with manual pages, completions, licences and checksums: target/dist.
# They need no C library and run on any Linux of their architecture.
# Usage: static.sh [TARGET…]; by default x86_64 and aarch64 with musl.
# It needs `pip install ziglang cargo-zigbuild` and `rustup target add` of the targets.
set -euo pipefail
cd "$(dirname "$0")/../.."

targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(x86_64-unknown-linux-musl aarch64-unknown-linux-musl)
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
out=target/dist
mkdir -p "$out"

# Without function names, which are useless in a release build: this saves 3 MB.
export CARGO_PROFILE_RELEASE_STRIP=symbols
for target in "${targets[@]}"; do
    cargo zigbuild --release --locked --bin carom --target "$target"
done

# A program that runs on this machine writes the documents for all targets.
own="target/$(uname -m)-unknown-linux-musl/release/carom"
[ -x "$own" ] || own="target/${targets[0]}/release/carom"
.github/scripts/documents.sh "$own" target/documents

for target in "${targets[@]}"; do
    .github/scripts/pack.sh "$target" "$version" "$out"
done
