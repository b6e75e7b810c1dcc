import { withUnit } from "../../controls/numbers";
import type { Erratum } from "../../protocol";
import { Maths } from "./Maths";

/** An erratum: printed and corrected formula, and the results of both. */
export function ErratumCard({ erratum }: { erratum: Erratum }) {
  const { unit } = erratum;
  return (
    <div className="equation">
      <dl className="erratum">
        <dt>As printed</dt>
        <dd className="scroll">
          {erratum.printed_formula ? <Maths node={erratum.printed_formula} block /> : erratum.printed}
          {erratum.printed_value !== null && <output>{withUnit(erratum.printed_value, 2, unit)}</output>}
        </dd>
        <dt>Correct</dt>
        <dd className="scroll">
          {erratum.correct_formula ? <Maths node={erratum.correct_formula} block /> : erratum.correct}
          {erratum.correct_value !== null && <output>{withUnit(erratum.correct_value, 2, unit)}</output>}
        </dd>
      </dl>
      <p className="hint">{erratum.reason}</p>
    </div>
  );
}
