"""What a page asks of the server, without a browser."""
import http.client
import json
import re
import socket
import time

NETWORK = (OSError, http.client.HTTPException)  # where the program has gone, or cut the connection
PAGE = {"X-Tapstudy": "1"}  # what forms of other sites cannot send


def ask(url, method, path, body=None):
    """Status and body of the reply."""
    connection = http.client.HTTPConnection(url.hostname, url.port, timeout=10)
    try:
        connection.request(method, url.path + path, body, PAGE)
        reply = connection.getresponse()
        return reply.status, reply.read()
    finally:
        connection.close()


def post(url, message):
    """The status."""
    return ask(url, "POST", "input", json.dumps(message))[0]


def open_stream(url, buffer_bytes=None):
    """The page's events, as a socket that the caller reads or not, and closes."""
    connection = socket.socket()
    connection.settimeout(10)
    if buffer_bytes:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
    try:
        connection.connect((url.hostname, url.port))
        connection.sendall(f"GET {url.path}events HTTP/1.1\r\nHost: {url.netloc}\r\n\r\n".encode())
        return connection
    except OSError:
        connection.close()
        raise


def next_trial_screen(url, patience_s=120):
    """The number of the screen that asks a trial's question; raises OSError if none comes."""
    end = time.monotonic() + patience_s
    with open_stream(url) as connection:
        text = b""
        while not (found := re.search(rb'"number":(\d+),"language":"\w+","kind":"trial"', text)):
            part = connection.recv(65536)
            if not part or time.monotonic() > end:
                raise OSError("no trial's screen came")
            text += part
    return int(found.group(1))
