// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqCartanBehavior
 * @brief what the filters do in ParaView's window beyond what XML can say
 *
 * - Numbers that filters report (properties with information_only) are read again
 *   after each update, time steps included. ParaView itself reads them before the
 *   update that an Apply starts, so that panels would be one Apply behind.
 * - Filters that are made in the window start with values that can be used at once:
 *   Mark Handle with the next free id and a box around an end of the surface, or the
 *   points that are selected; deformations with the handle that was marked last, and
 *   the box that moves it; measures with the surface before it moved as Reference.
 *   Scripts start with the defaults that XML declares.
 * - A Mark Handle filter is applied when it is made, and its output colored by handles.
 *   Ratios and errors are colored around their neutral value.
 *
 * ParaView starts it with the plugin.
 */
#ifndef pqCartanBehavior_h
#define pqCartanBehavior_h

#include "pqPipelineSource.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <memory>

class pqTraceFilter;
class pqView;

class pqCartanBehavior : public QObject
{
  Q_OBJECT

public:
  explicit pqCartanBehavior(QObject* parent = nullptr);
  ~pqCartanBehavior() override;

  /// Called by ParaView when the plugin is loaded and when the application ends.
  void startup();
  void shutdown();

private:
  void watchView(pqView* view);

  /// Reads the numbers of all filters of this plugin, once for all updates of a turn of
  /// the event loop.
  void refreshLater();
  void refresh();

  void startFilter(pqPipelineSource* filter);

  QTimer Refresh;

  /// The Mark Handle filter that was made last, until a view shows it.
  QPointer<pqPipelineSource> NewMarking;
  std::unique_ptr<pqTraceFilter> TraceFilter;
};

#endif
