import { Refusal } from "../../controls/Failure";
import { WalkRemedies } from "./WalkRemedies";

/** The refusal of a walk, beside the input that was changed last. */
export function WalkRefusal({ at }: { at: string }) {
  return (
    <Refusal of="walk" at={at}>
      <WalkRemedies />
    </Refusal>
  );
}
