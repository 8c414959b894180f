#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// The command `quadmark-queue`.
import { run } from './program.js';

process.exitCode = await run(process.argv.slice(2));
