"""The pages' server against whoever is not meant, and against too much of everything."""
import contextlib
import http.client
import json
import socket
import sys
import threading
import time
import unittest
from urllib.parse import urlparse

from page_client import NETWORK, next_trial_screen, open_stream, post
from program import Session


class ServerTest(unittest.TestCase):
    def setUp(self):
        self.session = Session("protocols/paper/discrimination.yaml")
        self.addCleanup(self.session.close)
        self.at = urlparse(self.session.participant)
        self.of_operator = urlparse(self.session.operator)

    def ask(self, path, method="GET", body=None, headers=(), host=None):
        connection = http.client.HTTPConnection(self.at.hostname, self.at.port, timeout=10)
        try:
            connection.putrequest(method, path, skip_host=True)
            for name, value in {"Host": host or self.at.netloc, **dict(headers)}.items():
                connection.putheader(name, value)
            if body is not None:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            reply = connection.getresponse()
            return reply.status, reply.read()
        finally:
            connection.close()

    def post(self, base, message, headers=(("X-Tapstudy", "1"),)):
        return self.ask(base.path + "input", "POST", json.dumps(message).encode(), headers)

    def test_nothing_is_served_without_the_token(self):
        wrong = "0" * (len(self.at.path) - 2)
        for path in ("/", "/style.css", f"/{wrong}/", f"/{wrong}/events", "//", "/%2e%2e/etc/passwd",
                     self.at.path[:-2] + "/", self.at.path[1:-1]):
            for method in ("GET", "POST", "PUT", "DELETE", "OPTIONS", "TRACE"):
                status = self.ask(path, method, b"{}")[0]
                self.assertIn(status, (400, 403, 404, 405, 501), f"{method} {path}")
        self.assertEqual(self.ask(self.at.path)[0], 200)

    def test_nothing_outside_the_pages_is_served(self):
        for path in ("../../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..%2f..%2fetc/passwd",
                     "scene/-1", "scene/99999999999999999999", "scene/", "no.js"):
            status, body = self.ask(self.at.path + path)
            self.assertIn(status, (400, 403, 404), path)
            self.assertNotIn(b"root:", body)

    def test_other_sites_and_names_are_refused(self):
        for headers in ({"Origin": "http://evil.example"}, {"Origin": "null"},
                        {"Sec-Fetch-Site": "cross-site"}, {"Sec-Fetch-Site": "same-site"}):
            self.assertEqual(self.ask(self.at.path, headers=headers)[0], 403, headers)
        for host in ("evil.example", f"evil.example:{self.at.port}", "127.0.0.1", "127.0.0.1:1"):
            self.assertEqual(self.ask(self.at.path, host=host)[0], 403, host)
        own = {"Origin": f"http://{self.at.netloc}", "Sec-Fetch-Site": "same-origin"}
        self.assertEqual(self.ask(self.at.path, headers=own)[0], 200)

    def raw(self, request):
        with socket.create_connection((self.at.hostname, self.at.port), timeout=10) as connection:
            connection.sendall(request)
            reply = b""
            with contextlib.suppress(OSError):
                while part := connection.recv(65536):
                    reply += part
        return reply

    def test_what_the_library_would_answer_by_itself_is_refused(self):
        upgrade = ("Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: "
                   "dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n")
        preflight = ("Origin: http://evil.example\r\nAccess-Control-Request-Method: POST\r\n"
                     "Access-Control-Request-Headers: X-Tapstudy\r\n\r\n")
        for path in ("/", self.at.path, self.at.path + "events"):
            for host in ("evil.example", self.at.netloc):
                head = f"GET {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example\r\n"
                self.assertIn(b" 403 ", self.raw((head + upgrade).encode())[:20])
            reply = self.raw(f"OPTIONS {path} HTTP/1.1\r\nHost: {self.at.netloc}\r\n{preflight}".encode())
            self.assertIn(b" 403 ", reply[:20])
            self.assertNotIn(b"Access-Control-Allow", reply)
        for junk in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", b"GET\r\n\r\n", b"\r\n\r\n",
                     b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n",
                     b"GET " + 20000 * b"/a" + b" HTTP/1.1\r\n\r\n",
                     b"GET http://evil.example/ HTTP/1.1\r\nHost: evil.example\r\n\r\n"):
            self.raw(junk)
        self.assertEqual(self.ask(self.at.path)[0], 200)

    def test_a_form_of_another_page_cannot_post(self):
        self.assertEqual(self.post(self.of_operator, {"command": "note x"}, ())[0], 405)
        self.assertEqual(self.session.rows("SELECT * FROM operator_action"), [])

    def test_each_page_can_do_only_its_own(self):
        self.assertEqual(self.post(self.at, {"command": "end it"})[0], 409)
        self.assertEqual(self.post(self.of_operator, {"screen": 1, "action": "go_on"})[0], 409)
        self.assertEqual(self.post(self.of_operator, {"command": "note x"})[0], 200)
        self.assertEqual(self.session.rows("SELECT detail FROM operator_action"), [("x",)])

    def test_bodies_that_are_no_input_are_refused(self):
        deep = b'{"action":"answer","screen":1,"value":' + 120000 * b"[" + 120000 * b"]" + b"}"
        self.assertEqual(self.ask(self.of_operator.path + "input", "POST",
                                  deep.replace(b"value", b"command"), {"X-Tapstudy": "1"})[0], 409)
        for body, allowed in ((b"", (409,)), (b"{", (409,)), (b"\xff\xfe", (409,)), (deep, (409,)),
                              (b"x" * 270000, (413,))):
            status = self.ask(self.at.path + "input", "POST", body, {"X-Tapstudy": "1"})[0]
            self.assertIn(status, allowed)
        self.assertEqual(self.post(self.of_operator, {"command": "note " + "x" * 3000})[0], 409)
        self.assertEqual(self.post(self.of_operator, {"command": "note \u0000 is no text"})[0], 409)
        self.assertEqual(self.post(self.of_operator, {"command": "note \u202e<script>"})[0], 200)

    def test_the_session_goes_on_with_a_flood_and_pages_that_do_not_read(self):
        for _ in range(40):
            self.addCleanup(open_stream(self.at, buffer_bytes=1024).close)
        is_over = threading.Event()

        def flood():
            while not is_over.is_set():
                try:
                    self.ask(self.at.path + "three.module.js")
                except NETWORK:
                    pass
        floods = [threading.Thread(target=flood) for _ in range(8)]
        for one in floods:
            one.start()
        try:
            self.answer_all()
        finally:
            is_over.set()
            for one in floods:
                one.join()
        self.assertEqual(self.session.wait(), 0, self.session.said())
        self.assertEqual(len(self.session.responses()), 8)

    def answer_all(self):
        end = time.monotonic() + 60
        while self.session.process.poll() is None and time.monotonic() < end:
            try:
                post(self.at, {"screen": next_trial_screen(self.at), "action": "answer", "value": "1"})
            except NETWORK:
                pass  # closed in the flood, or the session is over
            time.sleep(0.2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
