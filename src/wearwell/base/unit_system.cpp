#include "wearwell/base/unit_system.h"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>
#include <memory>
#include <mutex>
#include <string_view>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

struct Free {
  void operator()(ut_system* system) const { ut_free_system(system); }
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using System = std::unique_ptr<ut_system, Free>;
using UtUnit = std::unique_ptr<ut_unit, Free>;

// UDUNITS-2 defines a cycle as 2 pi radians, and hertz as 1/s.
constexpr std::array counts = {"cycle",  "revolution", "rotation", "turn",
                               "stroke", "closing",    "rev",      "count"};
// r/min (IEC 60050), U/min and Lastwechsel (German), tr/min (French), ciclos (Spanish)
constexpr std::array count_symbols = {
    "r",   "U",      "Umdr",   "Umdrehung", "Umdrehungen", "LW",    "Lastwechsel", "tr",
    "cyc", "Zyklus", "Zyklen", "Hub",       "Huebe",       "tours", "ciclo",       "ciclos"};

struct Name {
  const char* symbol;
  const char* meaning;
};
constexpr std::array<Name, 42> ours = {{{"reversal", "0.5 cycle"},
                                        {"reversals", "0.5 cycle"},
                                        {"hertz", "cycle/s"},
                                        {"Hz", "cycle/s"},
                                        {"rps", "cycle/s"},
                                        {"cps", "cycle/s"},
                                        {"rotation_per_second", "cycle/s"},
                                        {"rpm", "cycle/min"},
                                        {"RPM", "cycle/min"},
                                        {"Upm", "cycle/min"},
                                        {"Nm", "N.m"},
                                        {"Ncm", "N.cm"},
                                        {"Nmm", "N.mm"},
                                        {"Ws", "W.s"},
                                        {"Wh", "W.h"},
                                        {"kp", "kgf"},
                                        {"deg", "arc_degree"},
                                        {"hrs", "h"},
                                        {"Std", "h"},
                                        {"Stunde", "h"},
                                        {"Stunden", "h"},
                                        {"heures", "h"},
                                        {"horas", "h"},
                                        {"Minuten", "min"},
                                        {"minutos", "min"},
                                        {"Sekunden", "s"},
                                        {"Sek", "s"},
                                        {"Tage", "d"},
                                        {"Tag", "d"},
                                        {"jours", "d"},
                                        {"dias", "d"},
                                        {"mins", "min"},
                                        {"thou", "0.001 inch"},
                                        {"mil", "0.001 inch"},
                                        {"mils", "0.001 inch"},
                                        {"mikron", "um"},
                                        {"Mikron", "um"},
                                        {"mikrons", "um"},
                                        {"Mikrons", "um"},
                                        {"mikrometer", "um"},
                                        {"Mikrometer", "um"},
                                        {"permil", "0.001"}}};

struct TwoSizes {
  std::string_view word;
  const char* sizes;
};
constexpr std::array<TwoSizes, 7> ambiguous = {{
    {"ton", "a metric ton is 1000 kg, a short ton 907.185 kg; write t or short_ton"},
    {"gr", "a gram is 1 g, a grain 0.0648 g; write g or grain"},
    {"ppt", "a part per thousand is 1e-3, one per trillion 1e-12; write the number"},
    {"oz", "an ounce is 28.35 g, a fluid ounce 29.57 cm^3; write avoirdupois_ounce or fluid_ounce"},
    {"gallon", "a US gallon is 3.785 l, a British one 4.546 l; write l"},
    {"quart", "a US quart is 0.946 l, a British one 1.137 l; write l"},
    {"pint", "a US pint is 0.473 l, a British one 0.568 l; write l"},
}};

void unmap(ut_system* system, const std::string& name) {
  ut_unmap_name_to_unit(system, name.c_str(), UT_ASCII);
  ut_unmap_symbol_to_unit(system, name.c_str(), UT_ASCII);
}

bool map_symbol(ut_system* system, const Name& name) {
  const UtUnit meaning{ut_parse(system, name.meaning, UT_ASCII)};
  return meaning && ut_map_symbol_to_unit(name.symbol, UT_ASCII, meaning.get()) == UT_SUCCESS;
}

bool add_our_names(ut_system* system) {
  for (const std::string name : {"circle", "circles", "rotations_per_second", "hertzes"})
    unmap(system, name);
  for (const TwoSizes& each : ambiguous) {
    unmap(system, std::string(each.word));
    unmap(system, std::string(each.word) + "s");
  }
  for (const Name& name : ours) unmap(system, name.symbol);
  const UtUnit count{ut_new_base_unit(system)};
  bool good = count != nullptr;
  for (const std::string name : counts) {
    for (const std::string& form : {name, name + "s"}) {
      unmap(system, form);
      good = good && ut_map_name_to_unit(form.c_str(), UT_ASCII, count.get()) == UT_SUCCESS;
    }
  }
  good = good && ut_map_unit_to_name(count.get(), counts.front(), UT_ASCII) == UT_SUCCESS;
  for (const char* symbol : count_symbols)
    good = good && ut_map_symbol_to_unit(symbol, UT_ASCII, count.get()) == UT_SUCCESS;
  for (const Name& name : ours) good = good && map_symbol(system, name);
  return good;
}

const ut_system* unit_system() {
  static const System system = [] {
    ut_set_error_message_handler(ut_ignore);
    System read{ut_read_xml(nullptr)};
    if (!read)
      throw MachineError("cannot read the UDUNITS-2 unit database; is libudunits2 installed?");
    if (!add_our_names(read.get()))
      throw MachineError("the UDUNITS-2 unit database is not the expected one");
    return read;
  }();
  return system.get();
}

void multiply(ParsedUnit& result, const ut_unit* base, int power) {
  const char* name = ut_get_name(base, UT_ASCII);
  int& sum = result.dimension[name ? name : "?"];
  sum += power;
}

// The structure of a UDUNITS-2 unit: a product of base units, scaled and shifted any number of
// times.
extern "C" {
ut_status visit_basic(const ut_unit* unit, void* result) {
  multiply(*static_cast<ParsedUnit*>(result), unit, 1);
  return UT_SUCCESS;
}
ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers,
                        void* result) {
  for (int i = 0; i < count; ++i) multiply(*static_cast<ParsedUnit*>(result), bases[i], powers[i]);
  return UT_SUCCESS;
}
ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double origin,
                         void* result);
ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* result) {
  static_cast<ParsedUnit*>(result)->linear = false;
  return UT_SUCCESS;
}
ut_status visit_logarithm(const ut_unit*, double, const ut_unit*, void* result) {
  static_cast<ParsedUnit*>(result)->linear = false;
  return UT_SUCCESS;
}
}

constexpr ut_visitor visitor = {visit_basic, visit_product, visit_galilean, visit_timestamp,
                                visit_logarithm};

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double origin,
                         void* result) {
  const ut_status status = ut_accept_visitor(underlying, &visitor, result);
  ParsedUnit& unit = *static_cast<ParsedUnit*>(result);
  unit.offset += unit.scale * scale * origin;  // underlying = scale * (value + origin)
  unit.scale *= scale;
  return status;
}

// "N⁻¹" is "N^-1": UDUNITS-2 supports superscript digits but not a superscript sign.
std::string with_plain_powers(const std::string& text) {
  static constexpr std::array<std::string_view, 11> raised = {
      "\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074", "\u2075",
      "\u2076", "\u2077", "\u2078", "\u2079", "\u207b"};
  constexpr std::size_t minus = 10;
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    if (!rest.starts_with(raised[minus])) {
      result += rest.front();
      rest.remove_prefix(1);
      continue;
    }
    result += "^-";
    rest.remove_prefix(raised[minus].size());
    for (std::size_t digit = 0; digit < minus;) {
      if (!rest.starts_with(raised[digit])) {
        ++digit;
        continue;
      }
      result += static_cast<char>('0' + digit);
      rest.remove_prefix(raised[digit].size());
      digit = 0;
    }
    if (!rest.empty() && std::isalnum(static_cast<unsigned char>(rest.front()))) result += ' ';
  }
  return result;
}

}  // namespace

std::optional<ParsedUnit> parse_unit(const std::string& text) {
  std::string plain = with_plain_powers(text);
  boost::algorithm::replace_all(plain, "\u22c5", "\u00b7");  // the other multiplication dot
  boost::algorithm::replace_all(plain, "\u00a0", " ");       // no-break space
  boost::algorithm::replace_all(plain, "\u2212", "-");       // typographic minus sign
  static std::mutex one_at_a_time;                           // UDUNITS-2 parses with global state
  const std::lock_guard lock(one_at_a_time);
  const UtUnit unit{ut_parse(unit_system(), plain.c_str(), UT_UTF8)};
  if (!unit) return {};
  ParsedUnit result;
  if (ut_accept_visitor(unit.get(), &visitor, &result) != UT_SUCCESS) return {};
  std::erase_if(result.dimension, [](const auto& base) { return base.second == 0; });
  return result;
}

std::string two_sizes(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto in_word = [&](std::size_t i) {
      return i < text.size() &&
             (std::isalpha(static_cast<unsigned char>(text[i])) || text[i] == '_');
    };
    std::size_t end = at;
    while (in_word(end)) ++end;
    const std::string word = text.substr(at, end - at);
    for (const TwoSizes& each : ambiguous) {
      if (word == each.word || word == std::string(each.word) + "s") return each.sizes;
    }
    at = std::max(end, at + 1);
  }
  return {};
}

}  // namespace wearwell
