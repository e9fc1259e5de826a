#include "wearwell/study/role_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell {
namespace {

// "hours = h | time": words separated by bars; after "=" the unit that a word implies.
std::vector<RoleWord> words(std::string_view text) {
  std::vector<RoleWord> all;
  while (!text.empty()) {
    const std::size_t bar = std::min(text.find(" | "), text.size());
    const std::string_view word = text.substr(0, bar);
    const std::size_t equals = word.find(" = ");
    all.push_back(equals == word.npos ? RoleWord{word}
                                      : RoleWord{word.substr(0, equals), word.substr(equals + 3)});
    text.remove_prefix(std::min(bar + 3, text.size()));
  }
  return all;
}

}  // namespace

// Words are sorted from the most specific to the least. A longer word of another role in the
// heading ("mean stress", "cycles to failure") takes precedence.
const std::vector<RoleForm>& role_forms() {
  constexpr double any = 1e300;
  static const std::vector<RoleForm> forms = {
      // Measured quantities.
      {"depth",
       {"m"},
       "um",
       Cells::numbers,
       words("wear depth | depth of wear | worn depth | depth | linear wear | wear | "
             "verschleisstiefe | verschleißtiefe | linearer verschleiss | verschleiss | verschleiß "
             "| abrieb | abnutzung | profondeur | usure | profundidad | desgaste | usura"),
       1e-12,
       1.1e-3},
      {"volume",
       {"m^3"},
       "mm^3",
       Cells::numbers,
       words("worn volume | wear volume | volume loss | volume | verschleissvolumen | "
             "verschleißvolumen | verschleiss | verschleiß | volumen | volume d'usure | volumen de "
             "desgaste | usure | desgaste"),
       1e-30,
       1e-2},
      {"mass",
       {"kg"},
       "mg",
       Cells::numbers,
       words("mass loss | weight loss | worn mass | wear mass | wear | massenverlust | "
             "gewichtsverlust | masseverlust | verschleissmasse | verschleiß | abrieb | perte de "
             "masse | perte de poids | usure | pérdida de masa | pérdida de peso | desgaste"),
       1e-12,
       2e-3},
      {"crack",
       {"m"},
       "mm",
       Cells::numbers,
       words("crack length | crack size | crack depth | crack | risslänge | risstiefe | riss | "
             "longueur de fissure | fissure | longitud de grieta | grieta")},
      {"measured",
       {},
       "1",
       Cells::numbers,
       words("increase | growth | degradation | drift | loss | change | decrease | deviation | "
             "capacity | resistance | light output | luminous flux | output | thickness | backlash "
             "| vibration | leakage | leak rate | efficiency | strength | measured | measurement | "
             "reading | damage | wear | zunahme | abnahme | messwert | widerstand | kapazität | "
             "dicke | schädigung | verlust | verschleiss | augmentation | épaisseur | résistance | "
             "capacité | perte | mesure | usure | aumento | espesor | resistencia | capacidad | "
             "pérdida | medida | desgaste | value | valor | valeur")},
      {"response",
       {},
       "1",
       Cells::numbers,
       words("specific wear rate | wear rate | wear coefficient | coefficient of friction | "
             "friction coefficient | cof | friction | surface roughness | roughness | response | "
             "yield | verschleissrate | verschleißrate | verschleisskoeffizient | "
             "verschleißkoeffizient | reibungszahl | reibwert | reibungskoeffizient | rauheit | "
             "zielgrösse | zielgröße | taux d'usure | coefficient de frottement | frottement | "
             "rugosité | réponse | tasa de desgaste | coeficiente de fricción | fricción | "
             "rugosidad | respuesta | y")},
      // Exposure: distance and time.
      {"cycles",
       {"cycle"},
       "1",
       Cells::numbers,
       words("number of cycles | million cycles = 1e6 cycles | cycles | cycle | strokes | closings "
             "| zyklen | zyklus | lastwechsel | lastspiele | schwingspiele | schaltspiele | "
             "schaltungen | hübe | takte | nombre de cycles | número de ciclos | ciclos | cicli | "
             "n"),
       1e-3,
       1e12},
      {"revolutions",
       {"rev"},
       "1",
       Cells::numbers,
       words("million revolutions = 1e6 rev | revolutions | turns | umdrehungen | rev | tours | "
             "revoluciones | vueltas | giri")},
      {"time",
       {"s"},
       "h",
       Cells::numbers,
       words("operating hours = h | operating time | running time | run time | service time | test "
             "time | hours = h | time | duration | days = d | weeks = week | months = month | "
             "years = year | minutes = min | seconds = s | age | betriebsstunden = h | stunden = h "
             "| betriebszeit | laufzeit | versuchsdauer | prüfdauer | zeit | dauer | tage = d | "
             "wochen = week | monate = month | jahre = year | heures = h | jours = d | mois = "
             "month | temps | durée | horas = h | días = d | meses = month | tiempo | duración | "
             "tempo | h = h | t"),
       1e-6,
       any},
      {"distance",
       {"m"},
       "m",
       Cells::numbers,
       words("sliding distance | distance | mileage | travel | slip | km = km | kilometers = km | "
             "kilometres = km | miles = mile | gleitweg | reibweg | laufstrecke | laufleistung | "
             "strecke | weg | kilometer = km | distance de glissement | parcours | kilométrage = "
             "km | distancia | recorrido | kilometraje = km | path"),
       0.9,
       any},
      {"life",
       {"cycle", "s", "m"},
       "1",
       Cells::numbers,
       words("million cycles to failure = 1e6 cycles | cycles to failure | hours to failure = h | "
             "days to failure = d | km to failure = km | time to failure | time to rupture | "
             "rupture time | time to break | failure time | failure hours = h | ttf | lifetime | "
             "fatigue life | life | lives | endurance | bruchlastspielzahl | bruchschwingspielzahl "
             "| schwingspielzahl | bruchzyklen | lebensdauer | standzeit | ausfallzeit | cycles à "
             "rupture | nombre de cycles à rupture | durée de vie | ciclos hasta la rotura | "
             "ciclos a rotura | tiempo hasta el fallo | vida útil | vida | nf | n f")},
      {"lower",
       {"cycle", "s", "m"},
       "1",
       Cells::numbers,
       words("last good | last ok | last inspection | lower | from | left | von | untere | zuletzt "
             "gut | de | depuis | desde")},
      {"upper",
       {"cycle", "s", "m"},
       "1",
       Cells::numbers,
       words("first bad | found failed | failed by | upper | to | until | right | bis | obere | "
             "zuerst defekt | à | jusqu'à | hasta")},
      {"entry",
       {"cycle", "s", "m"},
       "1",
       Cells::numbers,
       words("entry | delayed entry | age at start | start age | truncation | eintritt | entrée | "
             "entrada")},
      // Conditions.
      {"force",
       {"N"},
       "N",
       Cells::numbers,
       words(
           "normal force | radial force | normal load | radial load | force | load | normalkraft "
           "| radialkraft | kraft | last | belastung | charge | effort | fuerza | carga | carico"),
       1e-6,
       any},
      {"pressure",
       {"Pa"},
       "MPa",
       Cells::numbers,
       words("contact pressure | pressure | flächenpressung | pressung | druck | pression | "
             "presión")},
      {"alternating_stress",
       {"Pa"},
       "MPa",
       Cells::numbers,
       words("stress amplitude | alternating stress | spannungsamplitude | ausschlagspannung | "
             "amplitude de contrainte | amplitud de tensión | amplitude | amplitud | stress | "
             "spannung | contrainte | tensión | esfuerzo | tensione | sa | s a | sigma a | σa | σ "
             "| sigma | s"),
       1,
       any},
      {"max_stress",
       {"Pa"},
       "MPa",
       Cells::numbers,
       words("max stress | maximum stress | peak stress | upper stress | stress max | smax | s max "
             "| oberspannung | contrainte maximale | contrainte max | tensión máxima | sigma max | "
             "sigma o")},
      {"min_stress",
       {"Pa"},
       "MPa",
       Cells::numbers,
       words("min stress | minimum stress | lower stress | stress min | smin | s min | "
             "unterspannung | contrainte minimale | contrainte min | tensión mínima | sigma min | "
             "sigma u")},
      {"mean_stress",
       {"Pa"},
       "MPa",
       Cells::numbers,
       words("mean stress | stress mean | mittelspannung | contrainte moyenne | tensión media | sm "
             "| s m | sigma m")},
      {"stress_ratio",
       {"1"},
       "1",
       Cells::numbers,
       words("stress ratio | load ratio | r ratio | spannungsverhältnis | rapport de contrainte | "
             "relación de tensiones | r | ratio")},
      {"strain",
       {"1"},
       "1",
       Cells::numbers,
       words("strain amplitude | total strain | strain | dehnungsamplitude | dehnung | amplitude "
             "de déformation | déformation | deformación")},
      {"temperature",
       {"K"},
       "degC",
       Cells::numbers,
       words("temperature | temperatur | température | temperatura | temp"),
       0.5,
       1.1},
      {"voltage",
       {"V"},
       "V",
       Cells::numbers,
       words("voltage | kv = kV | volt | spannung | tension | tensión | voltaje"),
       1e-9,
       any},
      {"speed",
       {"rev/s"},
       "rpm",
       Cells::numbers,
       words("rotational speed | speed | drehzahl | rpm = rpm | vitesse de rotation | vitesse | "
             "velocidad de giro | velocidad")},
      {"velocity",
       {"m/s"},
       "m/s",
       Cells::numbers,
       words("sliding speed | sliding velocity | velocity | speed | gleitgeschwindigkeit | "
             "geschwindigkeit | vitesse de glissement | vitesse | velocidad"),
       1e-9,
       any},
      {"work",
       {"N m"},
       "J",
       Cells::numbers,
       words("friction work | friction energy | work | energy | reibarbeit | reibungsarbeit | "
             "arbeit | énergie | trabajo")},
      // Dimensions of a plain bearing.
      {"clearance",
       {"m"},
       "um",
       Cells::numbers,
       words("radial clearance | clearance | lagerspiel | spiel | jeu radial | juego radial")},
      {"radius",
       {"m"},
       "mm",
       Cells::numbers,
       words("journal radius | shaft radius | radius | wellenradius")},
      {"length",
       {"m"},
       "mm",
       Cells::numbers,
       words("bearing length | length | width | länge | breite")},
      {"contact", {"1"}, "1", Cells::any, words("contact | kontakt")},
      // Item, count and status.
      {"status",
       {"1"},
       "1",
       Cells::any,
       words("status | outcome | result | runout | run out | censored | censoring | censor | cens "
             "| suspended | suspension | event | failed | failure | ended | state | zustand | "
             "durchläufer | zensiert | ausgefallen | ausfall | bruch | ergebnis | statut | état | "
             "censuré | défaillance | rupture | estado | censurado | fallo | falla | rotura")},
      {"mode",
       {"1"},
       "1",
       Cells::any,
       words("failure mode | failure cause | failure category | failure mechanism | cause of "
             "failure | "
             "mode of failure | root cause | mode | cause | ausfallart | ausfallursache | "
             "fehlerart | "
             "schadensart | mode de défaillance | cause de défaillance | modo de fallo | causa del "
             "fallo")},
      {"count",
       {"1"},
       "1",
       Cells::numbers,
       words("count | number of specimens | number of units | quantity | qty | freq | frequency | "
             "anzahl | stückzahl | nombre | quantité | cantidad")},
      {"unit",
       {"1"},
       "1",
       Cells::names,
       words("unit | specimen | sample | machine | device | component | part | item | serial "
             "number | serial | bearing | pump | motor | engine | laser | battery | cell | tool | "
             "plate | liner | vehicle | truck | asset | prüfling | prüfkörper | probe | maschine | "
             "gerät | bauteil | teil | lager | pumpe | fahrzeug | werkzeug | éprouvette | "
             "échantillon | pièce | numéro | pompe | probeta | muestra | pieza | máquina | unidad "
             "| equipo | bomba | id | nr | no")},
      {"label",
       {"1"},
       "1",
       Cells::any,
       words("material | batch | supplier | vendor | lot | type | series | group | operator | rig "
             "| werkstoff | charge | lieferant | los | typ | serie | gruppe | matériau | "
             "fournisseur | série | proveedor | lote | tipo")},
  };
  return forms;
}

const std::vector<std::string_view>& sale_words() {
  static const std::vector<std::string_view> words = {
      "sold",    "sale",   "deliver",   "ship",  "install", "in service", "commission",
      "verkauf", "liefer", "inbetrieb", "vente", "vendu",   "livr",       "venta"};
  return words;
}

const std::vector<std::string_view>& return_words() {
  static const std::vector<std::string_view> words = {"return",  "fail",   "claim", "repair",
                                                      "ausfall", "reklam", "rueck", "rück",
                                                      "retour",  "panne",  "fallo", "devol"};
  return words;
}

const RoleForm& role_form(std::string_view name) {
  const auto& forms = role_forms();
  const auto found = std::find_if(forms.begin(), forms.end(),
                                  [&](const RoleForm& each) { return each.name == name; });
  if (found != forms.end()) return *found;
  std::vector<std::string> names = {"unused"};
  for (const RoleForm& each : forms) names.emplace_back(each.name);
  throw InputError(fmt::format("'{}' is not a role of a column; use one of {}{}", name,
                               fmt::join(names, ", "), did_you_mean(std::string(name), names)));
}

}  // namespace wearwell
