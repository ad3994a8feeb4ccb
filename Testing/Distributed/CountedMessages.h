// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// How often this rank, hypre included, has called a function of MPI that sends or receives.
long long CountedMessages();
