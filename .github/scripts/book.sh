#!/usr/bin/env bash
# Builds the book target/book from the pages of docs/, and checks its links. Repository files that the pages link to are copied into it.
# It needs mdbook.
# Usage: book.sh
set -euo pipefail
cd "$(dirname "$0")/../.."

mdbook build docs
python3 - target/book << 'END'
import html, pathlib, re, shutil, sys

book = pathlib.Path(sys.argv[1])
pages = [page for page in book.glob("*.html") if page.name not in ("404.html", "print.html", "toc.html")]
link = re.compile(r'(href|src)="(?![a-z]+:|//)([^"#]*)(#[^"]*)?"')


def inside(found):
    """Redirects a link out of the book to a copy inside it; Markdown pages of the repository are copied as text."""
    kind, path, place = found.groups()
    if not path.startswith("../"):
        return found.group(0)
    source = pathlib.Path(path[3:])
    source = source if source.exists() else source.with_suffix(".md")
    copy = book / "repository" / source
    copy.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, copy)
    return f'{kind}="repository/{source}"'


texts = {page.name: link.sub(inside, page.read_text()) for page in pages}
for name, text in texts.items():
    (book / name).write_text(text)
count, broken = 0, []
for name, text in texts.items():
    for _, path, place in link.findall(text):
        count += 1
        path = html.unescape(path) or name
        leads_nowhere = not (book / path).exists()
        has_no_place = place and path in texts and f'id="{place[1:]}"' not in texts[path]
        if leads_nowhere or has_no_place:
            broken.append(f"{name}: {path}{place}")
print("\n".join(broken) or f"{count} links of {len(texts)} pages lead somewhere")
sys.exit(bool(broken))
END
