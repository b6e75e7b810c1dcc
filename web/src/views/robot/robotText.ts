/** The text of a robot file, or why it is none: in the words of the command line. */
export function robotText(content: Uint8Array): { text: string } | { problem: string } {
  return textOf(content, "a robot file");
}

/** The text of a file, or why it is none. */
export function textOf(content: Uint8Array, what: string): { text: string } | { problem: string } {
  const end = validEnd(content);
  if (end < content.length) return { problem: `byte ${end} is not UTF-8; ${what} is a text file` };
  return { text: new TextDecoder().decode(content) };
}

/** Length of the part that is valid UTF-8. */
function validEnd(content: Uint8Array): number {
  let [valid, tried] = [0, content.length];
  if (isValid(content)) return tried;
  // An incomplete character at the end of a part is no error: with more bytes it may be completed.
  while (valid + 1 < tried) {
    const middle = (valid + tried) >> 1;
    if (isValid(content.subarray(0, middle), true)) valid = middle;
    else tried = middle;
  }
  while (valid > 0 && !isValid(content.subarray(0, valid))) valid -= 1;
  return valid;
}

function isValid(content: Uint8Array, more = false): boolean {
  try {
    new TextDecoder("utf-8", { fatal: true }).decode(content, { stream: more });
    return true;
  } catch {
    return false;
  }
}
