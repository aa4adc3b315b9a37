// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/growth.h"

namespace vera::testing {

using vera::Growth;
using vera::growth;

} // namespace vera::testing
