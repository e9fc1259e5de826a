# Seconds of the longest tests on two cores, read by ctest where its tests are discovered: it begins with them, so
# that none of them runs alone at the end. A name of no test is passed over. Those in the browser wait for one another
# and come before these (COST 1000, tests/browser). A case of a suite that is named here has a process of its own.
macro(wearwell_longest seconds)
  foreach(name ${ARGN})
    list(APPEND wearwell_longest ${name})
    set("wearwell_seconds_${name}" ${seconds})
  endforeach()
endmacro()

# Suites whose cases are long each.
set(wearwell_cases_alone "cli: Tutorial" "faults: Faults")

wearwell_longest(300 "r: R CMD check")
wearwell_longest(200 "python: docs" "r: docs")
wearwell_longest(150
  "python: doctests"
  "formula_model: FormulaLevels.RemainingLivesOfASeenMachineAreCutAtThePlace"
  "cli: NewFromTables.CapacityThatFalls"
  "regress: SubsetSearch.TheSameWhateverTheThreads")
wearwell_longest(100
  "install: examples/cpp"
  "install: package"
  "python: notebooks"
  "python: lives"
  "python: data"
  "formula_model: LifeAnswers.OneGroupComparedWithAnother"
  "formula_model: FormulaFigures.PathsOfUnitsAreSmallMultiplesOnCommonAxes"
  "cli: Tutorial.PrintsWhatItShows/how_to_fleet"
  "cli: Tutorial.PrintsWhatItShows/how_to_failure_modes")
wearwell_longest(70
  "numbers: Processors"
  "cli: NewLifeTables"
  "cli: FatigueStudy"
  "cli: Generated"
  "python: workbench"
  "monitor: Stores"
  "python: plan"
  "python: types"
  "python: update"
  "r: ask"
  "formula_model: FormulaNumericalError.OfUnitsThatDifferTwofold"
  "formula_model: FormulaEdges.AnImproperPosteriorOfTwoUnitsIsRefusedNotACrash"
  "python: field"
  "study: Mutated.SummaryIsReadOrRefused"
  "study: Mutated.ReportIsReadOrRefused"
  "fatigue: SnTrust.NormalScatterOfLifeAsPrintedIsImproperUnderFlatPriors"
  "regress: SubsetSearch.StoppedEarlyItStatesAnHonestGap"
  "math: Normality.PValuesAreEven"
  "cli: UpdateCommand.MachinesThatDifferAreTheirFitOfAll"
  "cli: Tutorial.PrintsWhatItShows/how_to_spectrum"
  "cli: Tutorial.PrintsWhatItShows/reference_clutch"
  "cli: Tutorial.PrintsWhatItShows/tutorials_several_units")
wearwell_longest(40
  "fleet: DuckdbFleet"
  "cli: FitCommand"
  "cli: FatigueLife"
  "cli: NewFromTables"
  "cli: Clutch"
  "cluster: Cluster"
  "cluster: ClickhouseFleet"
  "cluster: ClickhouseShards"
  "infer: SamplerOnKnown"
  "in_service: ReadingsFleet"
  "monitor_program: Programs"
  "monitor_program: BrokerPrograms"
  "python: life_populations"
  "python: answers"
  "python: fits"
  "python: netcdf"
  "r: data"
  "r: field"
  "r: plan"
  "formula_model: FormulaProcessStudy.TheExampleFitsAsAGammaProcessToo"
  "mean_tail: MeanTailTest.DataReachToCorrespondingLivesUnderOtherConditions"
  "monitor_program: Programs.AreDecidedUpon"
  "monitor_program: Programs.KilledAtAnyMomentGoOnToTheSameBits"
  "monitor_program: PostgresPrograms.GoOnWhenTheServerIsBack"
  "formula_model: FormulaLevels.BLivesOfMachinesAreThoseOfTheirLaw"
  "formula_model: FormulaLives.OfLasersAreThoseOfADenseGrid"
  "bearing: Laws/OfBearing.ReadingsOneByOneAreTheFitOfAll/1"
  "bearing: Laws/OfBearing.ReadingsOneByOneAreTheFitOfAll/2"
  "bearing: WornArea.IntervalCoversTheTruth"
  "prognosis: CarriedState.ReadsMutationsOrRefusesThem"
  "fleet: LawSqlTest.DuckdbHasTheNumbersOfTheLibrary"
  "architecture: sources are formatted"
  "cli: FitCommand.OptionalConstantAndExponent"
  "cli: FatigueDriver.HistoriesThatAScaleMakesStressesOf"
  "cli: FatigueDriver.CurvesOfForcesAndStrainsTakeTheirLikeOnly"
  "cli: FatigueLife.InTheHoursOfTheSignal"
  "cli: FatigueHistory.ConstantAmplitudeAlongEveryCurve"
  "cli: NewFrom.DepthsOfSeveralBearings"
  "cli: NewFromTables.WhichLabelIsTheUnit"
  "cli: UpdateCommand.OtherTradesAreTheirFitOfAll"
  "cli: Tutorial.PrintsWhatItShows/README"
  "cli: Tutorial.PrintsWhatItShows/how_to_compare"
  "cli: Tutorial.PrintsWhatItShows/how_to_material_factor"
  "cli: Tutorial.PrintsWhatItShows/how_to_plan_next"
  "cli: Tutorial.PrintsWhatItShows/how_to_rul_of_one_machine"
  "cli: Tutorial.PrintsWhatItShows/how_to_subpopulations"
  "cli: Tutorial.PrintsWhatItShows/tutorials_monitoring"
  "cli: Tutorial.PrintsWhatItShows/tutorials_own_formula")
