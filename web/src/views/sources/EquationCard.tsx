import { Scroll } from "../../controls/Scroll";
import type { Equation } from "../../protocol";
import { valueText } from "./digits";
import { Maths } from "./Maths";

/** An equation of a document: formula, values, result, and the name in Tarsus. */
export function EquationCard({ equation }: { equation: Equation }) {
  const { symbol, formula, numbers, value, unit, ours, note } = equation;
  return (
    <div className="equation" data-testid={`equation-${equation.key}`}>
      <div className="equation-head">
        <span>{equation.name}</span>
        <output>{valueText(value, unit)}</output>
      </div>
      <Scroll label={`${equation.name}: formula`} className="maths">
        <Maths node={row(symbol, formula)} block />
        {numbers && <Maths node={row({ tag: "mrow", text: null, children: [] }, numbers)} block />}
      </Scroll>
      {(ours ?? equation.printed_value ?? note) && (
        <p className="hint">
          {ours && <>In Tarsus: {ours}. </>}
          {equation.printed_value && (
            <>Value printed in the document for its robot: {equation.printed_value}. </>
          )}
          {note}
        </p>
      )}
    </div>
  );
}

/** Symbol = formula. */
function row(left: Equation["symbol"], right: Equation["formula"]): Equation["symbol"] {
  if (!right) return left;
  const equals = { tag: "mo", text: "=", children: [] } as const;
  return { tag: "mrow", text: null, children: [left, { ...equals, children: [] }, right] };
}
