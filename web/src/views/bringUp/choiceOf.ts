import type { Question } from "../../protocol";

/** Key of the choice that a key of the keyboard stands for; null for none. */
export function choiceOf({ choices }: Pick<Question, "choices">, pressed: string): string | null {
  const key = pressed === "Enter" ? "" : pressed.toLowerCase();
  return choices.find((choice) => choice.key === key)?.key ?? null;
}
