import { type ReactNode, useEffect, useRef, useState } from "react";

/** Least size of a letter to which content is reduced [px]. */
const LEAST = 9;

/**
 * A box whose content is reduced to fit, as far as it stays legible; beyond that it scrolls horizontally, and can be
 * focused.
 */
export function Scroll({
  label,
  className = "",
  children,
}: {
  label: string;
  className?: string;
  children: ReactNode;
}) {
  const box = useRef<HTMLDivElement>(null);
  const [wide, setWide] = useState(false);
  useEffect(() => {
    const element = box.current;
    if (!element) return;
    const fit = () => {
      element.style.removeProperty("--fit");
      const size = parseFloat(getComputedStyle(element).getPropertyValue("--size")) || LEAST;
      const fitting = (size * element.clientWidth) / Math.max(1, element.scrollWidth);
      if (fitting < size)
        element.style.setProperty("--fit", `${Math.max(LEAST, Math.floor(fitting * 10) / 10)}px`);
      setWide(element.scrollWidth > element.clientWidth + 1);
    };
    const watch = new ResizeObserver(fit);
    watch.observe(element);
    return () => watch.disconnect();
  }, [children]);
  const reached = wide ? { tabIndex: 0, role: "region", "aria-label": label } : {};
  return (
    <div ref={box} className={`scroll ${className}`} {...reached}>
      {children}
    </div>
  );
}
