// SPDX-License-Identifier: Apache-2.0
// Tactus' frames on an Arduino with one motor and one angle sensor, such as a Hapkit. Adapt the part "your board" and
// upload it; then in a patch: driver = "serial_board", mechanism = "sector", radius = "70 mm".
// The frames: devices/gripper/frame.hpp and devices/board/board_frames.hpp. Untested on hardware.

// ---- your board ----
static const long baud = 115200;
static const unsigned long serial_number = 1;        // another one for each board: confirmations are kept by it
static const int pwm_pin = 5, direction_pin = 8, sensor_pin = A2;
static const float full_torque_Nm = 0.03;            // of the motor at full duty, at the sector: motor × transmission
static const float rad_per_count = 0.0000654;        // of the sector per count of the unwrapped sensor
static const int sensor_range = 1024, flip = 700;    // counts per turn of the magnet; a larger step is a flip

static long flips = 0;
static int last_raw = -1;

static float read_angle() {
  const int raw = analogRead(sensor_pin);
  if (last_raw >= 0 && raw - last_raw > flip) --flips;
  if (last_raw >= 0 && last_raw - raw > flip) ++flips;
  last_raw = raw;
  return rad_per_count * (float)(flips * (long)sensor_range + raw);
}

static void set_torque(float newton_metre) {
  float duty = newton_metre / full_torque_Nm;
  if (duty > 1) duty = 1;
  if (duty < -1) duty = -1;
  digitalWrite(direction_pin, duty >= 0 ? HIGH : LOW);
  analogWrite(pwm_pin, (int)(255 * (duty >= 0 ? duty : -duty)));
}

// ---- the frames: not to be changed ----
static const byte most_payload = 64;
static byte held[12 + most_payload];
static unsigned int held_size = 0, sequence = 0;
static unsigned long torque_at = 0;
static bool runs = false;

static unsigned long crc32(const byte* bytes, unsigned int size) {
  unsigned long c = 0xFFFFFFFFul;
  for (unsigned int i = 0; i < size; ++i) {
    c ^= bytes[i];
    for (byte bit = 0; bit < 8; ++bit) c = c & 1 ? 0xEDB88320ul ^ (c >> 1) : c >> 1;
  }
  return (~c) & 0xFFFFFFFFul;
}
static void put(byte* at, unsigned long value, byte size) {
  for (byte i = 0; i < size; ++i) at[i] = (byte)(value >> (8 * i));
}
static unsigned long get(const byte* at, byte size) {
  unsigned long value = 0;
  for (byte i = 0; i < size; ++i) value |= (unsigned long)at[i] << (8 * i);
  return value;
}

static void answer(unsigned int asked) {
  byte out[32] = {0xA5, 0x5A, 1, 4};
  put(out + 4, ++sequence, 2);
  put(out + 6, 20, 2);
  out[8] = runs ? 0 : 1;
  out[9] = 1;
  put(out + 10, asked, 2);
  put(out + 12, (unsigned long)(long)(read_angle() * 1e6), 4);
  put(out + 24, serial_number, 4);
  put(out + 28, crc32(out + 2, 26), 4);
  Serial.write(out, sizeof out);
}

/// A whole frame at the start of `held`: true when it was used up.
static bool take_frame() {
  if (held_size < 8) return false;
  const unsigned int payload = get(held + 6, 2), whole = 12 + payload;
  if (held_size < whole) return false;
  if (get(held + 8 + payload, 4) == crc32(held + 2, 6 + payload) && held[3] == 3 && payload == 10 && held[9] == 1) {
    runs = held[8] & 1;
    set_torque(runs ? (float)(int32_t)get(held + 10, 4) * 1e-6 : 0);
    torque_at = millis();
    answer(get(held + 4, 2));
    held_size -= whole;
    memmove(held, held + whole, held_size);
    return true;
  }
  return false;
}

/// Drops bytes at the start of `held` that begin no frame.
static void look() {
  while (held_size > 0) {
    const bool good = held[0] == 0xA5 && (held_size < 2 || held[1] == 0x5A) && (held_size < 3 || held[2] == 1) &&
                      (held_size < 8 || get(held + 6, 2) <= most_payload);
    if (good) {
      if (take_frame()) continue;
      if (held_size < 8 || held_size < 12 + get(held + 6, 2)) return;
    }
    memmove(held, held + 1, --held_size);
  }
}

void setup() {
  pinMode(pwm_pin, OUTPUT);
  pinMode(direction_pin, OUTPUT);
  set_torque(0);
  Serial.begin(baud);
}

void loop() {
  read_angle();  // often: flips must not be missed
  while (Serial.available() > 0 && held_size < sizeof held) {
    held[held_size++] = (byte)Serial.read();
    look();
  }
  if (millis() - torque_at > 20) {
    runs = false;
    set_torque(0);
  }
}
