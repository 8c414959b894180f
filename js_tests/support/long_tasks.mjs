// SPDX-License-Identifier: MIT
// How long a page's own thread is busy without a break.

/** Begins to note tasks of more than 50 ms. */
export function watchLongTasks(page) {
  return page.evaluate(() => {
    globalThis.longTasks = [];
    new PerformanceObserver((list) => globalThis.longTasks.push(...list.getEntries().map(({ duration }) => duration))).observe({ type: 'longtask' });
  });
}

/** Milliseconds of the longest one since; 0 when none took more than 50. */
export const longestTask = (page) => page.evaluate(() => Math.max(0, ...globalThis.longTasks));
