# check.sh R BUILD PACKAGE FOLDER: builds the tarball and checks it, offline; neither errors, warnings nor notes. The tests are run by
# ctest one by one, with the program beside them. R CMD build runs the vignettes, so the check does not run them again.
r=$1 build=$2 package=$3 folder=$4
rm -rf "$folder"
mkdir -p "$folder"
cp -r "$package" "$folder/wearwell"
cd "$folder"
# The repositories that R CMD check asks for their packages are an empty one here: without it, it would wait for the network.
mkdir -p empty/src/contrib
: >empty/src/contrib/PACKAGES
{
  printf 'menu_name\tURL\tdefault\tsource\twin.binary\tmac.binary\n'
  for each in CRAN BioCsoft BioCann BioCexp; do printf '%s\t%s\tfile://%s/empty\tTRUE\tTRUE\tFALSE\tFALSE\n' $each $each "$PWD"; done
} >repositories
export R_REPOSITORIES="$PWD/repositories"
# DuckDB's library is part of the package: 87 MB together.
export _R_CHECK_PKG_SIZES_THRESHOLD_=100
export WEARWELL_BUILD="$build" _R_CHECK_FORCE_SUGGESTS_=false _R_CHECK_SYSTEM_CLOCK_=false LC_ALL=C.UTF-8
"$r" --vanilla CMD build wearwell >build.log 2>&1 || { cat build.log; exit 1; }
for vignette in wearwell/vignettes/*.Rmd; do
  page=wearwell/inst/doc/$(basename "$vignette" .Rmd).html
  tar tzf wearwell_*.tar.gz "$page" >tar.log 2>&1 || { cat build.log tar.log; exit 1; }
done
"$r" --vanilla CMD check --no-manual --no-tests --no-vignettes wearwell_*.tar.gz >check.log 2>&1 || { cat check.log; exit 1; }
if grep -E 'WARNING|ERROR|NOTE' check.log; then cat check.log; exit 1; fi
grep '^Status' check.log
# The module finds the DuckDB of its package, wherever the package is, and loads NetCDF when it is asked for.
linked=$(ldd wearwell.Rcheck/wearwell/libs/wearwell.so)
case $linked in *"not found"* | *netcdf*) echo "$linked"; exit 1 ;; esac
case $linked in *wearwell.Rcheck/wearwell/*duckdb/libduckdb.so*) ;; *) echo "$linked"; exit 1 ;; esac
