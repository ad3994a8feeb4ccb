// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/ContentKey.h"

#include <functional>
#include <list>
#include <memory>
#include <typeinfo>

namespace cartan
{
/// What a filter keeps from one update to the next, found by the contents that it
/// was made from. What has not been used for longest goes first when the whole
/// takes more memory than allowed.
class KeptResults
{
public:
  /// The object that was kept under `key`, or a new one from `make()`, which
  /// returns a std::unique_ptr or std::shared_ptr to a T. T has GetBytes(), the
  /// memory that it holds by itself. What `make` throws leaves nothing behind.
  template <typename T, typename Make>
  std::shared_ptr<T> Get(ContentKey key, const Make& make)
  {
    key.Add(static_cast<std::uint64_t>(typeid(T).hash_code()));
    if (const std::shared_ptr<void> kept = this->Find(key))
    {
      return std::static_pointer_cast<T>(kept);
    }
    std::shared_ptr<T> made = make();
    this->Insert(
      key, made, [](const void* object) { return static_cast<const T*>(object)->GetBytes(); });
    return made;
  }

  /// Whether there is one. That counts as no use of it.
  template <typename T>
  bool Has(ContentKey key) const
  {
    key.Add(static_cast<std::uint64_t>(typeid(T).hash_code()));
    return this->Contains(key);
  }

  /// Keeps an object in place of one under the same key.
  template <typename T>
  void Replace(ContentKey key, std::shared_ptr<T> made)
  {
    key.Add(static_cast<std::uint64_t>(typeid(T).hash_code()));
    this->Forget(key);
    this->Insert(key, std::move(made),
      [](const void* object) { return static_cast<const T*>(object)->GetBytes(); });
  }

  /// Gives up all that was not used since the last call, or that of Trim().
  void KeepUsed();

  /// Gives up what was used longest ago until the rest takes at most `limit`
  /// bytes. What was used since the last call stays, whatever it takes.
  void Trim(std::size_t limit);

  std::size_t GetBytes() const;
  void Clear() { this->Entries.clear(); }

private:
  using Measure = std::size_t (*)(const void*);
  struct Entry
  {
    ContentKey Key;
    std::shared_ptr<void> Object;
    Measure Bytes;
    bool IsUsed;
  };

  std::shared_ptr<void> Find(const ContentKey& key);
  bool Contains(const ContentKey& key) const;
  void Forget(const ContentKey& key);
  void Insert(const ContentKey& key, std::shared_ptr<void> object, Measure bytes);

  std::list<Entry> Entries; ///< most recently used first
};
}
