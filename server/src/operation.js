// SPDX-License-Identifier: MIT
// Routes for whoever operates the server: is it alive, is it ready, what does it measure, what does it offer.

const document = (summary, response) => ({ summary, tags: ['operation'], response });

const status = (description, ...values) => ({
  description,
  content: {
    'application/json': {
      schema: { type: 'object', required: ['status'], properties: { status: { type: 'string', enum: values } } },
    },
  },
});

const text = (description, type) => ({ description, content: { [type]: { schema: { type: 'string' } } } });

export function registerOperation(app, { metrics, admission }) {
  app.get('/healthz', { config: { document: document('Is the process alive?', { 200: status('yes', 'alive') }) } },
    async () => ({ status: 'alive' }));

  const ready = document('May requests be sent here?', {
    200: status('yes', 'ready'), 503: status('not now', 'draining', 'under pressure'),
  });
  app.get('/readyz', { config: { document: ready } }, async (request, reply) => {
    if (admission.draining) return reply.code(503).send({ status: 'draining' });
    if (app.isUnderPressure()) return reply.code(503).send({ status: 'under pressure' });
    return { status: 'ready' };
  });

  const measured = document('Metrics for Prometheus', { 200: text('metrics', 'text/plain') });
  app.get('/metrics', { config: { document: measured } }, async (request, reply) =>
    reply.type(metrics.registry.contentType).send(await metrics.registry.metrics()));

  const described = document('This document', { 200: text('OpenAPI 3.1', 'application/json') });
  app.get('/openapi.json', { config: { document: described } }, async () => app.swagger());
}
