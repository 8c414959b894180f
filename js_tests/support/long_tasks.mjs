// SPDX-License-Identifier: MIT
// How long a page's own thread is busy without a break.

/** Begins to note tasks of more than 50 ms; where the browser does not tell of them (Firefox), the gaps between the beats of a clock. */
export function watchLongTasks(page) {
  return page.evaluate(() => {
    globalThis.longTasks = [];
    const note = (milliseconds) => { if (milliseconds > 50) globalThis.longTasks.push(milliseconds); };
    if (PerformanceObserver.supportedEntryTypes.includes('longtask')) {
      new PerformanceObserver((list) => list.getEntries().forEach(({ duration }) => note(duration))).observe({ type: 'longtask' });
      return;
    }
    const BEAT = 5;
    let last = performance.now();
    setInterval(() => {
      const now = performance.now();
      note(now - last - BEAT);
      last = now;
    }, BEAT);
  });
}

/** Milliseconds of the longest one since; 0 when none took more than 50. */
export const longestTask = (page) => page.evaluate(() => Math.max(0, ...globalThis.longTasks));
