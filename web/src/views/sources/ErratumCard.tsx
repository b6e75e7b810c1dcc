import { apart, significant } from "../../controls/numbers";
import { Scroll } from "../../controls/Scroll";
import type { Erratum, MathNode } from "../../protocol";
import { Maths } from "./Maths";

/** An erratum: the words of the document, the correct ones, and what both formulas give for this robot. */
export function ErratumCard({ erratum }: { erratum: Erratum }) {
  const { printed_value: wrong, correct_value: right, unit } = erratum;
  const both = wrong !== null && right !== null ? apart(wrong, right) : [digits(wrong), digits(right)];
  return (
    <div className="equation">
      <dl className="erratum">
        <dt>As printed</dt>
        <Version
          text={erratum.printed}
          formula={erratum.printed_formula}
          value={erratum.printed_formula && (both[0] ?? "no number")}
          unit={unit}
        />
        <dt>Correct</dt>
        <Version
          text={erratum.correct}
          formula={erratum.correct_formula}
          value={erratum.correct_formula && (both[1] ?? "no number")}
          unit={unit}
        />
      </dl>
      <p className="hint">{erratum.reason}</p>
    </div>
  );
}

interface VersionProps {
  text: string;
  formula: MathNode | null;
  value: string | null;
  unit: string;
}

function Version({ text, formula, value, unit }: VersionProps) {
  return (
    <dd>
      <span>{text}</span>
      {formula && (
        <Scroll label={`${text}: formula`} className="maths">
          <Maths node={formula} block />
        </Scroll>
      )}
      {value !== null && <output>{value === "no number" ? value : `= ${value} ${unit}`}</output>}
    </dd>
  );
}

function digits(value: number | null): string | null {
  return value === null ? null : significant(value, 4);
}
