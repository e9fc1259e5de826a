# examples.sh CMAKE BUILD EXAMPLES FOLDER COMPILER
cmake=$1 build=$2 examples=$3 folder=$4 compiler=$5
rm -rf "$folder/prefix" "$folder/build"
"$cmake" --install "$build" --prefix "$folder/prefix" >/dev/null
"$folder/prefix/bin/wearwell" --version
# What stands beside the program: manual page and completions.
grep -q '^.SS wearwell clutch life' "$folder/prefix/share/man/man1/wearwell.1"
grep -q '^complete .* wearwell' "$folder/prefix/share/bash-completion/completions/wearwell"
grep -q '^#compdef wearwell' "$folder/prefix/share/zsh/site-functions/_wearwell"
"$cmake" -S "$examples" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
"$cmake" --build "$folder/build"
expect() { # PROGRAM WORDS: what it prints holds the words
  out=$("$folder/build/$1" 2>/dev/null) || { echo "$1 ends with $?"; exit 1; }
  case $out in *"$2"*) ;; *) echo "$1 prints: $out"; exit 1 ;; esac
}
expect posterior 'tau 5'
expect subsets '(proven, R2p 1.0000)'
expect bearing 'worn to 60 um after'
expect memory 'stopped before completion'
