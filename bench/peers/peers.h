// SPDX-License-Identifier: MIT
// Watermarking schemes of other people, written from their papers to be measured beside ours. Never part of the product.
#pragma once

#include <memory>

#include "../schemes/scheme.h"

namespace quadmark::bench {

// One factory a scheme; its file names the paper, says where the paper leaves something open and what was decided.

}  // namespace quadmark::bench
