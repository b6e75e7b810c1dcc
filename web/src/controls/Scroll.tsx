import { type ReactNode, useEffect, useRef, useState } from "react";

/** A box that scrolls horizontally; it can be focused where its content is wider than the box. */
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
    const watch = new ResizeObserver(() => setWide(element.scrollWidth > element.clientWidth));
    watch.observe(element);
    return () => watch.disconnect();
  }, []);
  const reached = wide ? { tabIndex: 0, role: "region", "aria-label": label } : {};
  return (
    <div ref={box} className={`scroll ${className}`} {...reached}>
      {children}
    </div>
  );
}
