// Lines of pulse widths for hobby servos: the board behind Tarsus's bus "lines".
//
// Runs on boards whose Servo library drives 18 servos, such as Arduino Mega, Due, Teensy and RP2040.
// Each line from the computer ends with '*', the exclusive or of all bytes before it as two
// hexadecimal digits, and a line feed; lines that are damaged are ignored:
//
//   1500 1500 ... 1500*5A   pulse widths of all channels in microseconds; 0 ends the pulses
//   W 500*10                end all pulses after 500 ms without a good line; 0: never
//   ?*3F                    answered with "tarsus 18*.."
//   I*49                    answered with the levels of the inputs, "I 111111*.."
//
// Inputs have a pull-up: connect each foot switch between its input and ground. A foot on the ground is
// then a 0: foot_switches = { inputs = [0, 1, 2, 3, 4, 5], closed = false } in the calibration file.
//
// Supply the servos from their own battery, with its ground connected to the board's, never from the
// board's 5 V pin.

#include <Servo.h>

const uint8_t CHANNELS = 18;
const uint8_t PINS[CHANNELS] = {22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39};
const uint8_t INPUTS = 6;
const uint8_t INPUT_PINS[INPUTS] = {44, 45, 46, 47, 48, 49};
const uint16_t SHORTEST = 500, LONGEST = 2500;
const uint8_t LONGEST_LINE = 160;

Servo servos[CHANNELS];
uint16_t widths[CHANNELS];
char line[LONGEST_LINE + 1];
uint8_t length = 0;
bool tooLong = false;
uint32_t lastGoodLine = 0;
uint32_t limit = 500;

void setPulse(uint8_t channel, uint16_t width) {
  if (width == 0) {
    if (servos[channel].attached()) servos[channel].detach();
  } else {
    // Set before attaching: otherwise the servo begins with a jump to the middle.
    servos[channel].writeMicroseconds(width);
    if (!servos[channel].attached()) {
      servos[channel].attach(PINS[channel], SHORTEST, LONGEST);
      servos[channel].writeMicroseconds(width);
    }
  }
}

void endPulses() {
  for (uint8_t channel = 0; channel < CHANNELS; channel++) setPulse(channel, 0);
}

int8_t digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Cuts the checksum off; returns whether it was right.
bool checked() {
  if (length < 3 || line[length - 3] != '*') return false;
  int8_t high = digit(line[length - 2]), low = digit(line[length - 1]);
  if (high < 0 || low < 0) return false;
  uint8_t sum = 0;
  for (uint8_t i = 0; i < length - 3; i++) sum ^= (uint8_t)line[i];
  length -= 3;
  line[length] = 0;
  return sum == (uint8_t)(high << 4 | low);
}

// Reads a number of at most 5 digits; returns where it ends, or null if there is none.
const char *number(const char *text, uint32_t &value) {
  uint8_t digits = 0;
  for (value = 0; *text >= '0' && *text <= '9'; text++, digits++) value = 10 * value + (*text - '0');
  return digits >= 1 && digits <= 5 ? text : nullptr;
}

void takePulses() {
  const char *text = line;
  for (uint8_t channel = 0; channel < CHANNELS; channel++) {
    uint32_t width;
    text = number(text, width);
    if (!text || (width != 0 && (width < SHORTEST || width > LONGEST))) return;
    if (*text != (channel == CHANNELS - 1 ? 0 : ' ')) return;
    text++;
    widths[channel] = width;
  }
  // Only a line that is right to its end moves anything.
  for (uint8_t channel = 0; channel < CHANNELS; channel++) setPulse(channel, widths[channel]);
}

void answer(const char *text) {
  uint8_t sum = 0;
  for (const char *c = text; *c; c++) sum ^= (uint8_t)*c;
  char end[5];
  snprintf(end, sizeof end, "*%02X\n", sum);
  Serial.print(text);
  Serial.print(end);
}

void answerIdentity() {
  char text[16];
  snprintf(text, sizeof text, "tarsus %u", (unsigned)CHANNELS);
  answer(text);
}

void answerInputs() {
  char text[INPUTS + 3] = "I ";
  for (uint8_t input = 0; input < INPUTS; input++) text[input + 2] = digitalRead(INPUT_PINS[input]) == HIGH ? '1' : '0';
  text[INPUTS + 2] = 0;
  answer(text);
}

void takeLine() {
  if (tooLong || !checked()) return;
  lastGoodLine = millis();
  uint32_t value;
  if (line[0] == '?' && length == 1) {
    answerIdentity();
  } else if (line[0] == 'I' && length == 1) {
    answerInputs();
  } else if (line[0] == 'W' && line[1] == ' ') {
    const char *end = number(line + 2, value);
    if (end && *end == 0) limit = value;
  } else {
    takePulses();
  }
}

void setup() {
  for (uint8_t input = 0; input < INPUTS; input++) pinMode(INPUT_PINS[input], INPUT_PULLUP);
  Serial.begin(115200);
}

void loop() {
  while (Serial.available() > 0) {
    char c = Serial.read();
    if (c == '\n') {
      takeLine();
      length = 0;
      tooLong = false;
    } else if (c == '\r') {
      continue;
    } else if (length < LONGEST_LINE) {
      line[length++] = c;
    } else {
      tooLong = true;
    }
  }
  if (limit != 0 && millis() - lastGoodLine > limit) endPulses();
}
