// SPDX-License-Identifier: MIT
// How many threads the native library may use. Results never depend on it.
#pragma once

namespace quadmark {

/// Lets each call use up to `most` threads, its own included; 0, as it is at first, means one per core. For programs that
/// run several calls side by side. As wasm every call has one. May be called at any time, from any thread.
void useThreads(unsigned most);

}  // namespace quadmark
