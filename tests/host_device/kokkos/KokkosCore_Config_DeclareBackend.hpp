// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../parallel.hpp"
#include "../specializations.hpp"
#include "../teams.hpp"

#include_next <KokkosCore_Config_DeclareBackend.hpp>
