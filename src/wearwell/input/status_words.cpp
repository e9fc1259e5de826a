#include "wearwell/input/status_words.h"

#include <algorithm>
#include <array>
#include <boost/algorithm/string/trim.hpp>
#include <cctype>
#include <map>
#include <set>
#include <vector>

#include "wearwell/base/nearest.h"

namespace wearwell {
namespace {

/// Letters of the upper half of Latin-1 (U+00C0 to U+00FF, each after the byte C3) without accents.
constexpr std::array<std::string_view, 64> latin_letters = {
    "a", "a", "a", "a", "a", "a", "ae", "c", "e", "e", "e", "e", "i", "i", "i", "i",
    "d", "n", "o", "o", "o", "o", "o",  "",  "o", "u", "u", "u", "u", "y", "t", "ss",
    "a", "a", "a", "a", "a", "a", "ae", "c", "e", "e", "e", "e", "i", "i", "i", "i",
    "d", "n", "o", "o", "o", "o", "o",  "",  "o", "u", "u", "u", "u", "y", "t", "y"};

using Words = std::map<std::string, Censoring, std::less<>>;

const Words& status_words() {
  static const Words words = [] {
    Words all;
    const auto add = [&](Censoring seen, std::initializer_list<const char*> list) {
      for (const char* each : list) all.emplace(folded_word(each), seen);
    };
    add(Censoring::none,
        {"failure", "failed", "fail", "F", "broke", "broken", "breakage", "fracture", "fractured",
         "ruptured", "cracked", "crack", "dead", "died", "observed", "event", "uncensored", "NOK",
         "not ok", "worn out", "exact",
         // German
         "ausgefallen", "Ausfall", "defekt", "versagt", "Versagen", "Bruch", "gebrochen",
         "Dauerbruch", "Schwingbruch", "Anriss", "gerissen", "n.i.O.", "unzensiert",
         // French
         "défaillance", "défaillant", "défaillante", "rupture", "rompu", "rompue", "cassé",
         "cassée", "panne", "en panne", "hors service",
         // Spanish
         "fallo", "falla", "fallado", "fallada", "avería", "averiado", "averiada", "rotura", "roto",
         "rota"});
    add(Censoring::right,
        {"runout", "RO", "right", "right censored", "S", "suspended", "suspension", "susp", "C",
         "censored", "censor", "cens", "survived", "survivor", "surviving", "alive", "running",
         "still running", "still in service", "still alive", "in service", "OK", "unbroken",
         "intact", "not failed", "no failure", "not broken", "unfailed", "passed", "pass", "active",
         "withdrawn",
         // German
         "Durchläufer", "Durchlaeufer", "Läufer", "Laeufer", "läuft", "laeuft", "läuft noch",
         "laeuft noch", "läuft weiter", "laeuft weiter", "noch in Betrieb", "überlebt", "ueberlebt",
         "zensiert", "rechts", "rechtszensiert", "nicht ausgefallen", "nicht gebrochen",
         "kein Bruch", "kein Ausfall", "ohne Bruch", "ohne Ausfall", "in Betrieb", "intakt",
         "bestanden", "i.O.", "ungebrochen",
         // French
         "censuré", "censurée", "droite", "censuré à droite", "non rompu", "non rompue",
         "sans rupture", "pas de rupture", "survie", "survivant", "en service", "en marche",
         "suspendu", "suspendue", "non défaillant",
         // Spanish
         "censurado", "censurada", "derecha", "censura derecha", "suspendido", "suspendida",
         "sobrevivió", "superviviente", "en servicio", "en marcha", "en funcionamiento",
         "sin rotura", "sin fallo", "sin falla", "no roto", "no rota", "intacto", "intacta"});
    add(Censoring::left, {"left", "left censored", "links", "linkszensiert", "gauche",
                          "censuré à gauche", "izquierda", "censura izquierda"});
    add(Censoring::interval, {"interval", "interval censored", "Intervall", "intervallzensiert",
                              "intervalle", "censuré par intervalle", "intervalo"});
    return all;
  }();
  return words;
}

// Whether one insertion, deletion, substitution or transposition makes one word of the other.
bool one_edit_apart(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty() && a.front() == b.front()) a.remove_prefix(1), b.remove_prefix(1);
  while (!a.empty() && !b.empty() && a.back() == b.back()) a.remove_suffix(1), b.remove_suffix(1);
  if (a.size() <= 1 && b.size() <= 1) return true;
  return a.size() == 2 && b.size() == 2 && a[0] == b[1] && a[1] == b[0];
}

// Whether a word is a negation ("ungebrochen", "not failed") whose first syllable the other word has not: that one is the
// opposite, or another word ("abgebrochen"), rather than a misspelling.
bool loses_negation(std::string_view negated, std::string_view word) {
  for (const std::string_view prefix :
       {"nicht", "kein", "ohne", "sans", "pasde", "sin", "not", "non", "no", "un", "int"}) {
    if (negated.starts_with(prefix)) return !word.starts_with(prefix);
  }
  return false;
}

}  // namespace

std::string folded_word(std::string_view word) {
  std::string folded;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const auto c = static_cast<unsigned char>(word[i]);
    const unsigned char next = i + 1 < word.size() ? static_cast<unsigned char>(word[i + 1]) : 0;
    if (c < 0x80) {
      if (std::isalnum(c)) folded += static_cast<char>(std::tolower(c));
    } else if (c == 0xC3 && next >= 0x80 && next < 0xC0) {
      folded += latin_letters[next - 0x80u];
      ++i;
    } else if ((c == 0xCC && next >= 0x80) || (c == 0xCD && next >= 0x80 && next < 0xB0)) {
      ++i;  // a combining accent
    } else if (c == 0xC2 && next == 0xA0) {
      ++i;  // a no-break space
    } else {
      folded += word[i];
    }
  }
  return folded.empty() ? boost::algorithm::trim_copy(std::string(word)) : folded;
}

std::optional<Censoring> censoring_by_word(std::string_view word) {
  const auto found = status_words().find(folded_word(word));
  if (found == status_words().end()) return {};
  return found->second;
}

std::optional<std::string> near_status_word(std::string_view word) {
  std::vector<std::string> words;
  for (const auto& [each, seen] : status_words()) {
    if (each.size() > 2) words.push_back(each);
  }
  return near_name(folded_word(word), words);
}

std::optional<std::string> misspelt_runout(std::string_view word) {
  constexpr std::size_t shortest = 6, one_edit_until = 10;
  const std::string folded = folded_word(word);
  if (status_words().contains(folded)) return {};
  std::vector<std::string> words;
  for (const auto& [each, seen] : status_words()) {
    if (seen != Censoring::right || each.size() < shortest || each == "censor") continue;  // sensor
    if (loses_negation(each, folded)) continue;
    if (one_edit_apart(folded, each)) return each;
    if (each.size() >= one_edit_until) words.push_back(each);
  }
  return near_name(folded, words);
}

bool is_failure_of_no_mode(std::string_view word) {
  static const std::set<std::string, std::less<>> words = [] {
    std::set<std::string, std::less<>> all;
    for (const char* each :
         {"failure",    "failed",      "fail",     "dead",         "died",        "observed",
          "event",      "uncensored",  "NOK",      "not ok",       "ausgefallen", "Ausfall",
          "defekt",     "versagt",     "Versagen", "n.i.O.",       "unzensiert",  "défaillance",
          "défaillant", "défaillante", "en panne", "hors service", "fallo",       "falla",
          "fallado",    "fallada",     "avería",   "averiado",     "averiada"})
      all.insert(folded_word(each));
    return all;
  }();
  return words.contains(folded_word(word));
}

std::optional<bool> truth_in(std::string_view word) {
  static const std::map<std::string, bool, std::less<>> truths = {
      {"1", true},       {"true", true},  {"yes", true},    {"y", true},    {"wahr", true},
      {"ja", true},      {"j", true},     {"vrai", true},   {"oui", true},  {"verdadero", true},
      {"si", true},      {"0", false},    {"false", false}, {"no", false},  {"n", false},
      {"falsch", false}, {"nein", false}, {"faux", false},  {"non", false}, {"falso", false}};
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) return {};
  const auto found = truths.find(folded_word(word));
  if (found == truths.end()) return {};
  return found->second;
}

}  // namespace wearwell
