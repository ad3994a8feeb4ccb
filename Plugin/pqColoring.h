// SPDX-License-Identifier: BSD-3-Clause
/// The colors that results of the filters have in ParaView's window at first.
#pragma once

class pqPipelineSource;

/// Handles have colors of their own, free points are gray: the default color map of arrays
/// named Handle. Maps that the user has saved for that name come first.
void RegisterHandleColors();

/// Colors a Mark Handle filter's output by the handles in all views that show it. Returns
/// whether a view does.
bool ColorByHandle(pqPipelineSource* source);

/// Centers the color map of a ratio at 1 and that of an error at 0, where a view shows a
/// source by one: so far as its values go, but at most 0 to 2 for ratios, and three times
/// the root mean square for errors. Maps that do not adapt to the data are left alone.
void CenterColors(pqPipelineSource* source);
