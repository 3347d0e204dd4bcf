#!/usr/bin/env bash
# Builds a .deb and a .rpm of the static program for each target that static.sh has built: target/dist.
# It needs `cargo install cargo-deb cargo-generate-rpm`.
# Usage: packages.sh [TARGET…]; by default x86_64 and aarch64 with musl.
set -euo pipefail
cd "$(dirname "$0")/../.."

targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(x86_64-unknown-linux-musl aarch64-unknown-linux-musl)
for target in "${targets[@]}"; do
    cargo deb --no-build --no-strip --target "$target" --output target/dist/
    cargo generate-rpm --target "$target" --output target/dist/
done
