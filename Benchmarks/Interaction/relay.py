# SPDX-License-Identifier: BSD-3-Clause
"""Makes a connection on this machine as slow as a line to another one.

    relay.py --to HOST:PORT --counts FILE [--megabits R] [--delay-ms D]

Listens on a free port, prints it, takes one connection and passes its bytes on to HOST:PORT and back. In each
direction R megabits per second pass (default 20), and a byte comes D milliseconds after it has passed (default 50).
Bytes that wait for the line are at most those that pass in D milliseconds; the sender waits with the others. FILE
has two numbers of 64 bits at any time: bytes that were delivered to HOST:PORT, and those that were delivered back.
Ends when both directions have ended.
"""
import argparse
import mmap
import queue
import socket
import struct
import threading
import time

CHUNK = 4096  # bytes that pass as one: 1.6 ms of the default line
COUNTS = struct.Struct("<QQ")


def receive(source, waiting, rate, delay):
    """Takes what a sender has, as fast as the line does, and says when it is due: (time, bytes), at the end no bytes."""
    free = 0.0  # when the line has passed what it was given
    while True:
        try:
            data = source.recv(CHUNK)
        except OSError:  # a connection that was broken has ended, too
            data = b""
        free = max(free, time.monotonic()) + len(data) / rate
        waiting.put((free + delay, data))
        if not data:
            return
        time.sleep(max(0.0, free - delay - time.monotonic()))


def deliver(waiting, target, count):
    while True:
        due, data = waiting.get()
        time.sleep(max(0.0, due - time.monotonic()))
        try:
            if not data:
                target.shutdown(socket.SHUT_WR)
                return
            target.sendall(data)
        except OSError:
            return
        count(len(data))


def relay(near, far, counts, rate, delay):
    """Passes bytes between two sockets until both have ended. `counts` is memory for COUNTS."""
    totals = [0, 0]

    def counter(direction):
        def count(number):
            totals[direction] += number  # each by one thread
            COUNTS.pack_into(counts, 0, *totals)
        return count

    threads = []
    for direction, (source, target) in enumerate(((near, far), (far, near))):
        waiting = queue.SimpleQueue()
        threads += [threading.Thread(target=receive, args=(source, waiting, rate, delay), daemon=True),
                    threading.Thread(target=deliver, args=(waiting, target, counter(direction)), daemon=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--to", required=True)
    parser.add_argument("--counts", required=True)
    parser.add_argument("--megabits", type=float, default=20.0)
    parser.add_argument("--delay-ms", type=float, default=50.0)
    arguments = parser.parse_args()
    rate, delay = arguments.megabits * 1e6 / 8, arguments.delay_ms / 1e3
    with open(arguments.counts, "w+b") as file:
        file.write(bytes(COUNTS.size))
        file.flush()
        counts = mmap.mmap(file.fileno(), COUNTS.size)
    with socket.socket() as listener:
        # Else the system takes megabytes from the sender, for which a line has no place.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, max(CHUNK, int(rate * delay)))
        listener.bind(("localhost", 0))
        listener.listen(1)
        print(listener.getsockname()[1], flush=True)
        near, _ = listener.accept()
    far = socket.socket()
    far.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, max(CHUNK, int(rate * delay)))
    host, port = arguments.to.rsplit(":", 1)
    far.connect((host, int(port)))
    for end in (near, far):
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    relay(near, far, counts, rate, delay)


if __name__ == "__main__":
    main()
