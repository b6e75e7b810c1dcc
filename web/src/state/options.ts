import { create } from "zustand";

/** Display options, which are not part of the state of a link. */
export const useOptions = create<{ forces: boolean }>(() => ({ forces: false }));
