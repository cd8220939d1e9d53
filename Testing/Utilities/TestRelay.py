# SPDX-License-Identifier: BSD-3-Clause
"""TestRelay.py RELAY : Benchmarks/Interaction/relay.py passes all bytes on, in both directions, counts and delays them."""
import os
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

UP, DOWN = 1_000_003, 300_007  # bytes, no multiples of what passes at once
DELAY = 0.05  # seconds


def receive_all(connection):
    received = b""
    while data := connection.recv(65536):
        received += data
    return received


def answer(listener, reply, received):
    """The server: everything in, then everything out."""
    connection, _ = listener.accept()
    with connection:
        received.append(receive_all(connection))
        connection.sendall(reply)


def main():
    generator = random.Random(1)
    up, down = generator.randbytes(UP), generator.randbytes(DOWN)
    received = []
    with socket.socket() as listener, tempfile.TemporaryDirectory() as folder:
        listener.bind(("localhost", 0))
        listener.listen(1)
        server = threading.Thread(target=answer, args=(listener, down, received), daemon=True)
        server.start()
        counts = os.path.join(folder, "counts")
        relay = subprocess.Popen(
            [sys.executable, sys.argv[1], "--to", f"localhost:{listener.getsockname()[1]}", "--counts", counts,
             "--megabits", "200", "--delay-ms", str(1e3 * DELAY)], stdout=subprocess.PIPE, text=True)
        try:
            client = socket.create_connection(("localhost", int(relay.stdout.readline())), timeout=60)
            began = time.monotonic()
            client.sendall(up)
            client.shutdown(socket.SHUT_WR)
            reply = receive_all(client)
            seconds = time.monotonic() - began
            client.close()
            assert relay.wait(timeout=60) == 0, "the relay has failed"
        finally:
            relay.kill()
        server.join(60)
        with open(counts, "rb") as file:
            counted = struct.unpack("<QQ", file.read())
    assert received == [up], f"the server got {len(received[0])} bytes, or other ones"
    assert reply == down, f"the client got {len(reply)} bytes, or other ones"
    assert counted == (UP, DOWN), f"the relay has counted {counted}"
    # The end comes after the last byte of each direction, so there is no way to be quicker.
    least = 2 * DELAY + (UP + DOWN) / (200e6 / 8)
    assert seconds >= least, f"{seconds:.3f} s passed; the line takes at least {least:.3f}"


if __name__ == "__main__":
    main()
