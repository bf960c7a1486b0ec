# SPDX-License-Identifier: Apache-2.0
"""An arm that is not there: presses down on a ball again and again until it feels something. arm.py [PORT]"""

import math
import socket
import struct
import sys
import time

port = int(sys.argv[1]) if len(sys.argv) > 1 else 47000
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.setblocking(False)
begin, largest = time.monotonic(), 0.0
while time.monotonic() - begin < 20 and largest < 0.1:
    t = time.monotonic() - begin
    z = 0.004 * math.cos(math.pi * t) - 0.001
    try:
        link.sendto(struct.pack("<4d", 0.0, 0.0, z, 0.0), ("127.0.0.1", port))
        largest = max(largest, math.hypot(*struct.unpack("<3d", link.recv(24))))
    except (BlockingIOError, ConnectionRefusedError):
        pass  # nothing yet
    time.sleep(0.001)
print(f"largest force: {largest:.2f} N")
sys.exit(0 if largest >= 0.1 else 1)
