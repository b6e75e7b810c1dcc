// Runs the sketch on a computer. A line of input is a time in ms, the levels of the inputs as binary digits, and the
// bytes that arrive then, in hexadecimal digits; a line of output is what the sketch sent, in hexadecimal digits, and
// the pulse widths of all channels.
#include "Servo.h"

#include "../pulse_lines.ino"

#include <iostream>
#include <sstream>

std::uint32_t now = 0;
Port Serial;
int levels[64];

int main() {
  setup();
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string high, bytes;
    words >> now >> high >> bytes;
    for (std::size_t i = 0; i < high.size(); i++) levels[INPUT_PINS[i]] = high[i] - '0';
    Serial = Port();
    loop();
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) Serial.in += static_cast<char>(std::stoi(bytes.substr(i, 2), nullptr, 16));
    loop();
    std::printf("[");
    for (unsigned char c : Serial.out) std::printf("%02x", c);
    std::printf("]");
    for (Servo &servo : servos) std::printf(" %d", servo.on ? servo.width : 0);
    std::printf("\n");
    std::fflush(stdout);
  }
}
