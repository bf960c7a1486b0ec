# SPDX-License-Identifier: Apache-2.0
"""An arm that is not there: it presses on a ball, twice a second, until the run ends, and prints what it felt. arm.py [PORT]"""

import math
import socket
import struct
import sys
import time

port = int(sys.argv[1]) if len(sys.argv) > 1 else 47000
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.setblocking(False)
link.connect(("127.0.0.1", port))
begin, largest, has_answered = time.monotonic(), 0.0, False
while time.monotonic() - begin < 30:
    height = 0.004 * math.cos(4 * math.pi * (time.monotonic() - begin)) - 0.001  # m above the ball
    try:
        link.send(struct.pack("<4d", 0.0, 0.0, height, 0.0))
        largest = max(largest, math.hypot(*struct.unpack("<3d", link.recv(24))))
        has_answered = True
    except BlockingIOError:
        pass  # nothing new
    except ConnectionRefusedError:
        if has_answered:
            break
    time.sleep(0.001)
print(f"largest force: {largest:.2f} N")
sys.exit(0 if largest >= 0.1 else 1)
