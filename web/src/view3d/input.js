// SPDX-License-Identifier: MIT
// What turns the view: mouse and touch (one finger turns, two zoom), the wheel, and keys.

const RADIANS_PER_PIXEL = 0.008, RADIANS_PER_KEY = 0.15, ZOOM_PER_KEY = 1.2;

/** @param move  { turn(azimuth, height), zoom(factor), reset() } */
export function followPointers(canvas, move) {
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const before = down.size === 2 ? spread() : 0;
    const x = event.clientX, y = event.clientY;
    down.set(event.pointerId, { x, y });
    if (down.size === 1) move.turn((last.x - x) * RADIANS_PER_PIXEL, (y - last.y) * RADIANS_PER_PIXEL);
    if (before > 0) move.zoom(spread() / before);
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => down.delete(event.pointerId));
  canvas.addEventListener('wheel', (event) => {
    // Pages scroll past a view; it zooms once it was clicked into, or with the key for zooming.
    if (document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    move.zoom(Math.exp(-event.deltaY * 0.001));
  }, { passive: false });
}

export function followKeys(canvas, move) {
  const keys = {
    ArrowLeft: () => move.turn(-RADIANS_PER_KEY, 0),
    ArrowRight: () => move.turn(RADIANS_PER_KEY, 0),
    ArrowUp: () => move.turn(0, RADIANS_PER_KEY),
    ArrowDown: () => move.turn(0, -RADIANS_PER_KEY),
    '+': () => move.zoom(ZOOM_PER_KEY),
    '=': () => move.zoom(ZOOM_PER_KEY),
    '-': () => move.zoom(1 / ZOOM_PER_KEY),
    0: () => move.reset(),
  };
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key]();
  });
}
