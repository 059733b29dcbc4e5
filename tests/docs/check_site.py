#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Builds the site and checks it: links, descriptions, alternative texts, one main heading a page,
and dark colours.

Usage: check_site.py DOXYGEN ROOT FOLDER     builds FOLDER/site first
       check_site.py SITE                    checks a site that is there
"""
import html.parser
import pathlib
import subprocess
import sys
import urllib.parse


class PageOfSite(html.parser.HTMLParser):
    """Links, anchors, descriptions and main headings of a page, and images without alt text."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.descriptions, self.faults = [], set(), [], []
        self.headings = 0
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[name] for name in ("id", "name") if given.get(name)}
        self.links += [given[name] for name in ("href", "src") if given.get(name)]
        self.headings += tag == "h1"
        if tag == "img" and not (given.get("alt") or "").strip():
            self.faults.append(f"image {given.get('src')} has no alternative text")
        if tag == "meta" and given.get("name") == "description":
            self.descriptions.append((given.get("content") or "").strip())

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)


def broken_links(site, path, page, pages):
    for link in page.links:
        parts = urllib.parse.urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = path
        if parts.path:
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve()
        if not target.is_file() or site not in target.parents:
            yield f"link to {link}: not there"
        elif parts.fragment and target in pages:
            anchor = urllib.parse.unquote(parts.fragment)
            if anchor not in pages[target].anchors:
                yield f"link to {link}: no such place"


def check(site):
    """Returns all faults, as (page, sentence). Pages in api/ are Doxygen's own work and are not
    checked, since Doxygen 1.9.4 links some of them to pages that it leaves out. Their index must
    exist."""
    pages = {path: PageOfSite(path) for path in sorted(site.rglob("*.html"))
             if path.relative_to(site).parts[0] not in ("_static", "api")}
    faults = []
    for path, page in pages.items():
        found = [*broken_links(site, path, page, pages), *page.faults]
        if len(page.descriptions) != 1 or len(page.descriptions[0]) < 20:
            found.append(f"{len(page.descriptions)} descriptions; accepted: one, of 20 letters")
        if page.headings != 1 and path.name != "search.html":
            found.append(f"{page.headings} main headings; accepted: 1")
        faults += [(path.relative_to(site), sentence) for sentence in found]
    if not (site / "api/index.html").is_file():
        faults.append((pathlib.Path("api/index.html"), "not there"))
    styles = "".join(path.read_text(encoding="utf-8") for path in site.glob("_static/**/furo.css"))
    if "prefers-color-scheme:dark" not in styles.replace(" ", ""):
        faults.append((pathlib.Path("_static"), "no dark colours where the system asks for them"))
    print(f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links")
    return faults


def main(arguments):
    if len(arguments) not in (1, 3):
        print(__doc__, file=sys.stderr)
        return 2
    site = pathlib.Path(arguments[0])
    if len(arguments) == 3:
        doxygen, root, folder = arguments
        site = pathlib.Path(folder) / "site"
        if subprocess.run([sys.executable, "-B", f"{root}/docs/site/build_site.py", folder,
                           "--doxygen", doxygen], check=False).returncode != 0:
            return 1
    faults = check(site.resolve())
    for path, sentence in faults:
        print(f"{path}: {sentence}")
    print(f"{len(faults)} faults" if faults else "no faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
