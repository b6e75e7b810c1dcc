import { create } from "zustand";

/** What the picture shows besides; a matter of taste, so no part of the state that a link restores. */
export const useOptions = create<{ forces: boolean }>(() => ({ forces: false }));
