# Seconds of the longest tests on two cores, read by ctest where its tests are discovered: it begins with them, so
# that none of them runs alone at the end. A name of no test is passed over. Those in the browser wait for one another
# and come before these (COST 1000, tests/browser).
function(wearwell_longest seconds)
  set_tests_properties(${ARGN} PROPERTIES COST ${seconds})
endfunction()

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
  [=[cli: Tutorial.PrintsWhatItShows/how_to_fleet  # GetParam() = "docs/how-to/fleet.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_failure_modes  # GetParam() = "docs/how-to/failure-modes.md"]=])
wearwell_longest(70
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
  [=[cli: Tutorial.PrintsWhatItShows/how_to_spectrum  # GetParam() = "docs/how-to/spectrum.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/reference_clutch  # GetParam() = "docs/reference/clutch.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/tutorials_several_units  # GetParam() = "docs/tutorials/several-units.md"]=])
wearwell_longest(40
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
  [=[cli: Tutorial.PrintsWhatItShows/README  # GetParam() = "README.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_compare  # GetParam() = "docs/how-to/compare.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_material_factor  # GetParam() = "docs/how-to/material-factor.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_plan_next  # GetParam() = "docs/how-to/plan-next.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_rul_of_one_machine  # GetParam() = "docs/how-to/rul-of-one-machine.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/how_to_subpopulations  # GetParam() = "docs/how-to/subpopulations.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/tutorials_monitoring  # GetParam() = "docs/tutorials/monitoring.md"]=]
  [=[cli: Tutorial.PrintsWhatItShows/tutorials_own_formula  # GetParam() = "docs/tutorials/own-formula.md"]=])
