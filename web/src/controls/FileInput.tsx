import type { RefObject } from "react";

interface Props {
  /** Opens the dialogue: a button that is seen clicks it. */
  input: RefObject<HTMLInputElement | null>;
  label: string;
  testId: string;
  onFile: (file: File) => void;
}

/** The hidden input behind a button that loads a TOML file. */
export function FileInput({ input, label, testId, onFile }: Props) {
  return (
    <input
      ref={input}
      type="file"
      accept=".toml,text/plain"
      className="hidden-text"
      tabIndex={-1}
      aria-label={label}
      data-testid={testId}
      onChange={(event) => {
        const file = event.target.files?.[0];
        event.target.value = "";
        if (file) onFile(file);
      }}
    />
  );
}
