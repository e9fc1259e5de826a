# package.sh CPACK BUILD EXAMPLES FOLDER: the Debian package is made, and installed, used and removed in a copy-on-write view of this machine, which stays
# as it is. Ends with 77 where such a view is not possible: only root can make one.
cpack=$1 build=$2 examples=$3 folder=$4
rm -rf "$folder/deb"
"$cpack" --config "$build/CPackConfig.cmake" -B "$folder/deb" >/dev/null
deb=$(ls "$folder"/deb/*.deb)
fail() { echo "$1"; exit 1; }
has() { dpkg-deb --contents "$deb" | grep -q " ./$1\$" || fail "$1 is not in the package"; }
has usr/bin/wearwell
has usr/lib/wearwell/libduckdb.so
has usr/lib/systemd/system/wearwell-monitor@.service || has lib/systemd/system/wearwell-monitor@.service
has usr/share/wearwell/grafana.json
has usr/share/man/man1/wearwell.1
has usr/share/bash-completion/completions/wearwell
has usr/share/zsh/site-functions/_wearwell
dpkg-deb --field "$deb" Depends | grep -q libudunits2 || fail 'the libraries that the program needs are no dependencies'
dpkg-deb --contents "$deb" | grep -qE 'include/|\.a$' && fail 'the library is in the package'

[ "$(id -u)" = 0 ] || { echo 'only root can install it in a view of this machine'; exit 77; }
exec unshare --mount --fork sh -e "$(dirname "$0")/package_use.sh" "$deb" "$examples" "$folder"
