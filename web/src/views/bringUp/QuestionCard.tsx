import { useEffect, useRef, useState } from "react";

import { isTyping } from "../../app/useShortcuts";
import type { Question } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { choiceOf } from "./choiceOf";

/** A question and a button for each choice; their keys work too, and Enter is the first choice without a key. */
export function QuestionCard({ question }: { question: Question }) {
  const { number, title, text, choices } = question;
  const head = useRef<HTMLHeadingElement>(null);
  const [answered, setAnswered] = useState(false);
  const refused = useStudio((studio) => studio.failures.answer !== undefined);
  const waiting = answered && !refused;

  // Screen readers read the question, and the keys go to the page.
  useEffect(() => head.current?.focus({ preventScroll: true }), []);

  const answer = (key: string) => {
    setAnswered(true);
    ask({ type: "answer", number, key });
  };
  useEffect(() => {
    if (waiting) return;
    const press = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || isTyping(event.target)) return;
      // Enter on a button presses that button.
      if (event.key === "Enter" && event.target instanceof HTMLButtonElement) return;
      const key = choiceOf(question, event.key);
      if (key === null) return;
      event.preventDefault();
      setAnswered(true);
      ask({ type: "answer", number, key });
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, [question, number, waiting]);

  return (
    <section className="question" aria-labelledby="question">
      <p className="hint">{title}</p>
      <h3 id="question" ref={head} tabIndex={-1} data-testid="question">
        {text}
      </h3>
      <div className="choices" role="group" aria-label="Answers">
        {choices.map((choice) => (
          <button
            key={choice.key}
            type="button"
            className="button"
            disabled={waiting}
            data-testid={`choice-${choice.key || "enter"}`}
            onClick={() => answer(choice.key)}
          >
            {choice.text} <kbd aria-hidden="true">{choice.key || "Enter"}</kbd>
          </button>
        ))}
      </div>
    </section>
  );
}
