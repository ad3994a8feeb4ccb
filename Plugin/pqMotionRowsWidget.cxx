// SPDX-License-Identifier: BSD-3-Clause
#include "pqMotionRowsWidget.h"

#include "pqCoreUtilities.h"
#include "pqHandleMotions.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTableWidget>
#include <QVBoxLayout>

#include <algorithm>

pqMotionRowsWidget::pqMotionRowsWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Summary(new QLabel(this))
  , Table(new QTableWidget(MotionRowLength, 0, this))
  , Remove(new QPushButton(tr("Remove"), this))
{
  this->setProperty(property);
  auto* add = new QPushButton(tr("Add"), this);
  auto* putBack = new QPushButton(tr("Put All Handles Back"), this);
  add->setObjectName("Add");
  add->setToolTip(tr("Adds a motion of another handle."));
  putBack->setObjectName("PutBack");
  putBack->setToolTip(tr("Moves all handles back to their places in the input."));
  this->Summary->setObjectName("Summary");
  this->Table->setObjectName("Table");
  this->Remove->setObjectName("Remove");
  this->Remove->setToolTip(tr("Removes the motion of the selected column."));
  this->Table->setVerticalHeaderLabels({ tr("Handle"), tr("Scale X"), tr("Scale Y"), tr("Scale Z"),
    tr("Angle (degrees)"), tr("Axis X"), tr("Axis Y"), tr("Axis Z"), tr("Center X (length)"),
    tr("Center Y (length)"), tr("Center Z (length)"), tr("Translation X (length)"),
    tr("Translation Y (length)"), tr("Translation Z (length)") });
  this->Table->horizontalHeader()->hide();
  this->Table->horizontalHeader()->setDefaultSectionSize(70);
  this->Table->verticalHeader()->setDefaultSectionSize(22);
  this->Table->setMinimumHeight(22 * MotionRowLength + 4);

  auto* buttons = new QHBoxLayout();
  buttons->addWidget(add);
  buttons->addWidget(this->Remove);
  auto* layout = new QVBoxLayout(this);
  layout->setMargin(0);
  layout->setSpacing(2);
  // Above instead of beside the table, whose numbers a narrow panel would hide.
  this->setShowLabel(false);
  layout->addWidget(new QLabel(property->GetXMLLabel(), this));
  layout->addWidget(this->Summary);
  layout->addWidget(this->Table);
  layout->addLayout(buttons);
  layout->addWidget(putBack);

  QObject::connect(add, &QPushButton::clicked, this, &pqMotionRowsWidget::add);
  QObject::connect(this->Remove, &QPushButton::clicked, this, &pqMotionRowsWidget::remove);
  QObject::connect(putBack, &QPushButton::clicked, this,
    [this]
    {
      ChangeAtOnce(
        this->proxy(), tr("Put All Handles Back"), [this] { PutAllHandlesBack(this->proxy()); });
    });
  QObject::connect(this->Table, &QTableWidget::cellChanged, this, &pqMotionRowsWidget::edit);
  this->fill();
  this->addPropertyLink(this, "rows", SIGNAL(rowsChanged()), property);
  this->setChangeAvailableAsChangeFinished(true);
  pqCoreUtilities::connect(property, vtkCommand::ModifiedEvent, this, SLOT(notice()));
}

void pqMotionRowsWidget::notice()
{
  if (vtkSMPropertyHelper(this->property()).GetNumberOfElements() == 0)
  {
    this->setRows({});
  }
}

void pqMotionRowsWidget::setRows(const QList<QVariant>& rows)
{
  if (rows != this->Rows)
  {
    this->Rows = rows;
    this->fill();
    Q_EMIT this->rowsChanged();
  }
}

void pqMotionRowsWidget::fill()
{
  const QSignalBlocker blocker(this->Table);
  const int columns = this->Rows.size() / MotionRowLength;
  this->Table->setColumnCount(columns);
  for (int i = 0; i < columns * MotionRowLength; ++i)
  {
    this->Table->setItem(i % MotionRowLength, i / MotionRowLength,
      new QTableWidgetItem(QString::number(this->Rows[i].toDouble(), 'g', 6)));
  }
  this->Summary->setText(columns == 1 ? tr("1 other handle moves")
      : columns > 1                   ? tr("%1 other handles move").arg(columns)
                                      : tr("no other handle moves"));
  this->Table->setVisible(columns > 0);
  this->Remove->setEnabled(columns > 0);
}

void pqMotionRowsWidget::edit(int line, int column)
{
  bool isNumber = false;
  const double value = this->Table->item(line, column)->text().toDouble(&isNumber);
  QList<QVariant> rows = this->Rows;
  if (isNumber)
  {
    rows[column * MotionRowLength + line] = value;
  }
  if (rows == this->Rows)
  {
    this->fill();
  }
  this->setRows(rows);
}

void pqMotionRowsWidget::add()
{
  std::vector<double> numbers;
  for (const QVariant& number : this->Rows)
  {
    numbers.push_back(number.toDouble());
  }
  QList<QVariant> rows = this->Rows;
  for (const double number : NewMotionRow(this->proxy(), numbers))
  {
    rows.push_back(number);
  }
  this->setRows(rows);
}

void pqMotionRowsWidget::remove()
{
  const int column = std::max(this->Table->currentColumn(), 0);
  this->setRows(
    this->Rows.mid(0, column * MotionRowLength) + this->Rows.mid((column + 1) * MotionRowLength));
}
