// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/KeptResults.h"

#include <algorithm>

namespace cartan
{
std::shared_ptr<void> KeptResults::Find(const ContentKey& key)
{
  const auto found = std::find_if(this->Entries.begin(), this->Entries.end(),
    [&key](const Entry& entry) { return entry.Key == key; });
  if (found == this->Entries.end())
  {
    return nullptr;
  }
  this->Entries.splice(this->Entries.begin(), this->Entries, found);
  found->IsUsed = true;
  return found->Object;
}

bool KeptResults::Contains(const ContentKey& key) const
{
  return std::any_of(this->Entries.begin(), this->Entries.end(),
    [&key](const Entry& entry) { return entry.Key == key; });
}

void KeptResults::Forget(const ContentKey& key)
{
  this->Entries.remove_if([&key](const Entry& entry) { return entry.Key == key; });
}

void KeptResults::KeepUsed()
{
  this->Entries.remove_if([](const Entry& entry) { return !entry.IsUsed; });
  for (Entry& entry : this->Entries)
  {
    entry.IsUsed = false;
  }
}

void KeptResults::Insert(const ContentKey& key, std::shared_ptr<void> object, Measure bytes)
{
  this->Entries.push_front({ key, std::move(object), bytes, true });
}

void KeptResults::Trim(std::size_t limit)
{
  std::size_t total = this->GetBytes();
  while (total > limit && !this->Entries.empty() && !this->Entries.back().IsUsed)
  {
    const Entry& oldest = this->Entries.back();
    total -= std::min(total, oldest.Bytes(oldest.Object.get()));
    this->Entries.pop_back();
  }
  for (Entry& entry : this->Entries)
  {
    entry.IsUsed = false;
  }
}

std::size_t KeptResults::GetBytes() const
{
  std::size_t total = 0;
  for (const Entry& entry : this->Entries)
  {
    total += entry.Bytes(entry.Object.get());
  }
  return total;
}
}
