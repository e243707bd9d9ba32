#pragma once
// How a field of results.json is declared. Each struct in the file lists its fields once:
//
//   struct Row {
//     size_t acne = 0;
//     double biasError() const;
//     static constexpr auto fields() {
//       return std::tuple(field("acne", &Row::acne, {.says = "...", .metric = true}),
//                         field("bias_error", &Row::biasError, {...}), ...);
//     }
//   };
//
// From that list it is written and read back (results_file.h), shown by the terminal's table and by the page, accepted
// by --fail-if, and held against docs/results.md. A function in place of a member is written and not read.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

namespace gnomon {

// How a number is shown.
enum class NumberKind {
  Plain,
  Count,
  Share,  // of the scored pixels, as per cent
  Error,  // over the mean, from 0.1 % to many times
  Milliseconds,
};

// What a file has where there is no value, and whether a reader puts up with a field that is not there. Values that are
// std::optional may be missing always.
enum class Absent {
  Refused,
  Earlier,  // files of earlier schemas lack it, or a person may leave it out
  LeftOut,  // of a std::optional: no field where there is no value, else null
};

// Where a column is left out when it would be empty, or 0 in all rows.
enum class Hides { Never, OnPage, Everywhere };

// How readily the terminal's table leaves a column out: never; where the line would be too long, the higher the sooner;
// or wherever not all columns are asked for.
inline constexpr int kKept = 0;
inline constexpr int kWideOnly = 9;

struct TableColumn {
  const char* head = "";  // empty: no column
  int width = 0;
  int decimals = 0;
  int leftOut = kKept;
};

// All but `says`, `absent` and `inFile` are for numbers.
struct FieldNotes {
  const char* unit = "";
  const char* says = "";  // for docs/results.md
  Absent absent = Absent::Refused;
  NumberKind kind = NumberKind::Plain;
  const char* title = "";  // of the page's column; empty: none
  TableColumn table;       // of the terminal's
  Hides hides = Hides::Never;
  bool ranks = false;   // rows are ranked by it
  bool metric = false;  // --fail-if accepts it
  bool inFile = true;
  double least = -1e300, most = 1e300;  // that a reader accepts
};

// `get`: a member, or a function of a const Record&.
template <typename Get>
struct Field {
  const char* name;
  Get get;
  FieldNotes notes;

  static constexpr bool isMember = std::is_member_object_pointer_v<Get>;
};

template <typename Get>
constexpr Field<Get> field(const char* name, Get get, const FieldNotes& notes = {}) {
  return {name, get, notes};
}

template <typename T>
concept Record = requires {
  T::fields();
};

template <Record R, typename Visit>
void forEachField(const Visit& visit) {
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, R::fields());
}

template <typename T>
inline constexpr bool kIsOptional = false;
template <typename T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

// A field that holds a number, or may: what tables, pages and thresholds are made of.
template <Record R>
struct NumberField {
  const char* name;
  FieldNotes notes;
  bool mayBeAbsent;
  std::function<std::optional<double>(const R&)> of;
};

// In the order of the list.
template <Record R>
std::vector<NumberField<R>> numberFields() {
  std::vector<NumberField<R>> numbers;
  forEachField<R>([&](const auto& field) {
    const auto value = [get = field.get](const R& record) { return std::invoke(get, record); };
    using Value = std::remove_cvref_t<decltype(value(std::declval<const R&>()))>;
    if constexpr (std::is_arithmetic_v<Value>)
      numbers.push_back(
          {field.name, field.notes, false, [=](const R& record) { return static_cast<double>(value(record)); }});
    else if constexpr (std::is_convertible_v<Value, std::optional<double>>)
      numbers.push_back(
          {field.name, field.notes, true, [=](const R& record) { return std::optional<double>(value(record)); }});
  });
  return numbers;
}

// Whether a row has a value, and where all have one, whether a row has another than 0.
template <Record R>
bool isInAny(const NumberField<R>& field, const std::vector<R>& rows) {
  for (const R& row : rows)
    if (field.mayBeAbsent ? field.of(row).has_value() : field.of(row) != 0.0) return true;
  return false;
}

// A cell of the terminal's table, to the right within its column's width.
std::string tableCell(const FieldNotes& notes, std::optional<double> value);

// The declared columns of a table: its head, and one line a row.
template <Record R>
class DeclaredColumns {
 public:
  // Those that are left out less readily than `from`, and `kept` in any case.
  explicit DeclaredColumns(const std::vector<R>& rows, int from = kWideOnly + 1, std::string_view kept = "") {
    for (NumberField<R>& field : numberFields<R>())
      if (field.notes.table.width > 0 && (field.notes.table.leftOut < from || field.name == kept) &&
          (field.notes.hides != Hides::Everywhere || isInAny(field, rows)))
        columns_.push_back(std::move(field));
  }
  std::string head() const {
    std::string text;
    for (const NumberField<R>& column : columns_) text += tableHead(column.notes.table);
    return text;
  }
  std::string line(const R& row) const {
    std::string text;
    for (const NumberField<R>& column : columns_) text += tableCell(column.notes, column.of(row));
    return text;
  }

 private:
  static std::string tableHead(const TableColumn& column) {
    const std::string head = column.head;
    const size_t width = static_cast<size_t>(column.width);
    return " " + std::string(head.size() < width ? width - head.size() : 0, ' ') + head;
  }

  std::vector<NumberField<R>> columns_;
};

}  // namespace gnomon
