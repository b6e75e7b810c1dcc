// As much of Arduino's libraries as the sketch needs, for compiling it on a computer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

struct Servo {
  bool on = false;
  int width = 0;
  bool attached() { return on; }
  void attach(int, int, int) { on = true; }
  void detach() { on = false; }
  void writeMicroseconds(int microseconds) { width = microseconds; }
};

struct Port {
  std::string in, out;
  std::size_t at = 0;
  void begin(long) {}
  int available() { return in.size() - at; }
  int read() { return in[at++]; }
  void print(const char *text) { out += text; }
};

constexpr int LOW = 0, HIGH = 1, INPUT_PULLUP = 2;
extern int levels[64];
inline void pinMode(int pin, int mode) { levels[pin] = mode == INPUT_PULLUP; }
inline int digitalRead(int pin) { return levels[pin]; }

extern std::uint32_t now;
extern Port Serial;
inline std::uint32_t millis() { return now; }
