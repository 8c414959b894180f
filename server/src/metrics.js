// SPDX-License-Identifier: MIT
// What /metrics tells, in the text format of Prometheus. No label holds anything that a client chose.
import { collectDefaultMetrics, Counter, Gauge, Histogram, Registry } from 'prom-client';

const SECONDS = [0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100];

/** A registry of its own per server, so that several may live in one process. */
export function createMetrics(pool, admission) {
  const registry = new Registry();
  collectDefaultMetrics({ register: registry });
  const registers = [registry];
  const gauge = (name, help, read) => new Gauge({ name, help, registers, collect() { this.set(read()); } });
  gauge('quadmark_requests_inside', 'Requests being read, waiting or worked on', () => admission.taken);
  gauge('quadmark_pool_waiting', 'Requests waiting for a thread', () => pool.waiting);
  gauge('quadmark_pool_working', 'Requests worked on', () => pool.working);
  gauge('quadmark_threads_ended', 'Threads ended in the middle of their work by a time limit, a client that left or a failure', () => pool.ended);
  const requests = new Histogram({
    name: 'quadmark_request_seconds', help: 'Time from headers to answer', buckets: SECONDS, labelNames: ['route', 'status'], registers,
  });
  const failures = new Counter({ name: 'quadmark_failures_total', help: 'Failed requests by error code', labelNames: ['route', 'code'], registers });
  const work = new Histogram({
    name: 'quadmark_work_seconds', help: 'Time in a thread', buckets: SECONDS, labelNames: ['operation'], registers,
  });
  const verdicts = new Counter({ name: 'quadmark_verdicts_total', help: 'Results of extract', labelNames: ['verdict'], registers });
  return {
    registry,
    /** Of an answered request. */
    answered: (route, status, seconds) => requests.observe({ route, status }, seconds),
    failed: (route, code) => failures.inc({ route, code }),
    worked: (operation, seconds) => work.observe({ operation }, seconds),
    verdict: (verdict) => verdicts.inc({ verdict }),
  };
}
