# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Serves the page and its data to this machine only. Only the page's scripts, style and icon are
sent without the token."""

from __future__ import annotations

import asyncio
import hmac
import pathlib
import re
import secrets
import signal
import sys
from typing import Callable

import tornado.httpserver
import tornado.netutil
import tornado.web

from .reader import Reader
from .run import Run

PAGE = pathlib.Path(__file__).resolve().parent / "page"
SCRIPT = "text/javascript"
FILES = {"/page.js": SCRIPT, "/spins.js": SCRIPT, "/lines.js": SCRIPT, "/page.css": "text/css",
         "/icon.svg": "image/svg+xml"}


class _Handler(tornado.web.RequestHandler):
    def set_default_headers(self):
        ancestors = self.settings["frame_ancestors"]
        policy = f"default-src 'self'; base-uri 'none'; frame-ancestors {ancestors}"
        self.set_header("Content-Security-Policy", policy)
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-store")

    def prepare(self):
        host, hosts = self.request.host, self.settings["hosts"]
        origin = self.request.headers.get("Origin", f"http://{host}")
        token = self.get_query_argument("token", "")
        if host not in hosts:
            self.refuse(403, f"host {host}: not of this page; accepted: {' or '.join(hosts)}")
        elif origin != f"http://{host}":
            self.refuse(403, f"origin {origin}: another page; accepted: http://{host}")
        elif self.request.path not in FILES and not hmac.compare_digest(
                token.encode(), self.settings["token"].encode()):
            self.refuse(403, "token: missing or wrong; accepted: the address that cayspin printed")

    def refuse(self, status, sentence):
        self.set_status(status)
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{sentence}\n")

    def write_error(self, status_code, **_):
        self.refuse(status_code, f"{self.request.method} {self.request.path}: {self._reason}; "
                                 "accepted: what the page asks for")

    def whole(self, name):
        text = self.get_query_argument(name, "")
        if not re.fullmatch("[0-9]{1,9}", text):
            raise ValueError(f"{name} {text!r}: no number; accepted: a whole number")
        return int(text)


class _Page(_Handler):
    def get(self):
        path = self.request.path
        if path == "/":
            self.finish((PAGE / "index.html").read_bytes())
        elif path in FILES:
            self.set_header("Content-Type", FILES[path])
            self.finish((PAGE / path[1:]).read_bytes())
        else:
            self.refuse(404, f"{path}: there is no such page; accepted: /")


class _Data(_Handler):
    def get(self, what):
        reader, run = self.settings["reader"], self.settings["run"]
        plane = self.get_query_argument("plane", "")
        answers = {
            "news": lambda: {**reader.news(self.whole("frames"), self.whole("samples")),
                             "run": run and run.state(), "message": run.message() if run else ""},
            "frame": lambda: reader.frame(self.whole("number"), plane),
            "positions": lambda: reader.positions(plane),
            "path": lambda: reader.path_of(self.whole("place"), plane, self.whole("first"))}
        try:
            answer = answers[what]()
        except ValueError as error:
            return self.refuse(400, error)
        if isinstance(answer, bytes):
            self.set_header("Content-Type", "application/octet-stream")
        self.finish(answer)


class _Steering(_Handler):
    def post(self):
        run, action = self.settings["run"], self.get_query_argument("action", "")
        if run is None:
            self.refuse(403, "steer: the page started no run; accepted: the page of a scene")
        elif action not in ("pause", "resume", "stop"):
            self.refuse(400, f"action {action!r}: unknown; accepted: pause, resume, stop")
        else:
            getattr(run, action)()
            self.finish()


async def serve(reader: Reader, run: Run | None, port: int, announce: Callable[[str], None],
                in_notebook: bool) -> None:
    """Serves until SIGINT or SIGTERM, in a notebook also until standard input is closed."""
    try:
        sockets = tornado.netutil.bind_sockets(port, "127.0.0.1")
    except OSError as error:
        raise ValueError(f"cayspin: --port {port}: {error.strerror}; accepted: a free port") from None
    port, token = sockets[0].getsockname()[1], secrets.token_urlsafe(24)
    application = tornado.web.Application(
        [("/(news|frame|positions|path)", _Data), ("/steer", _Steering)],
        default_handler_class=_Page, log_function=lambda handler: None, reader=reader, run=run,
        hosts=[f"127.0.0.1:{port}", f"localhost:{port}"], token=token,
        frame_ancestors="http://127.0.0.1:* http://localhost:*" if in_notebook else "'none'")
    tornado.httpserver.HTTPServer(application).add_sockets(sockets)
    over, loop = asyncio.Event(), asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, over.set)
    if in_notebook:
        loop.add_reader(sys.stdin, over.set)
    announce(f"http://127.0.0.1:{port}/?token={token}")
    await over.wait()
