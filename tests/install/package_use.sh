# package_use.sh DEB EXAMPLES FOLDER: in a mount namespace of its own. Installs the package over this machine's system, uses it as its own user, removes it.
deb=$1 examples=$2 folder=$3
fail() { echo "$1"; exit 1; }
mount -t tmpfs tmpfs /mnt
mkdir /mnt/upper /mnt/work /mnt/root
mount -t overlay overlay -o lowerdir=/,upperdir=/mnt/upper,workdir=/mnt/work /mnt/root 2>/dev/null || { echo 'no overlay of the root is possible'; exit 77; }
mount -t proc proc /mnt/root/proc
mount --bind /dev /mnt/root/dev
mount -t tmpfs tmpfs /mnt/root/tmp
cp "$deb" /mnt/root/tmp/wearwell.deb
cp -r "$examples/fleet" /mnt/root/tmp/fleet
in_root() { chroot /mnt/root /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }

in_root dpkg --install /tmp/wearwell.deb >/mnt/log 2>&1 || { cat /mnt/log; fail 'dpkg cannot install it'; }
in_root getent passwd wearwell | grep -q nologin || fail 'there is no user wearwell without a shell'
in_root stat -c '%U %G %a' /var/lib/wearwell /etc/wearwell | tr '\n' ';' | grep -q '^wearwell wearwell 750;root wearwell 750;$' ||
  fail 'the folders of stores and configurations belong to others'

# As the service does: a configuration in /etc/wearwell, a store in /var/lib/wearwell, nothing else to write, no privileges.
in_root sh -ec '
  cd /tmp/fleet
  wearwell fit study.toml -o /etc/wearwell/study-results --quiet --no-report
  sed "s|url = \"fleet.sqlite\"|url = \"/var/lib/wearwell/fleet.sqlite\"|" monitor.toml >/etc/wearwell/pumps.toml
  chgrp -R wearwell /etc/wearwell && chmod -R g=rX,o= /etc/wearwell
  systemd-analyze verify /lib/systemd/system/wearwell-monitor@.service 2>&1 | grep -i "wearwell-monitor.*\(unknown\|invalid\|failed to parse\)" && exit 1
  echo "{\"time\": \"2026-05-05T12:00:00Z\", \"machine\": \"M1\", \"use_h\": 900, \"wear_um\": 17.5}" >/tmp/one.jsonl
  setpriv --reuid wearwell --regid wearwell --clear-groups --no-new-privs -- wearwell monitor /etc/wearwell/pumps.toml --once --json </tmp/one.jsonl >/tmp/out.json
  grep -q "\"stored\":1" /tmp/out.json
  man -w wearwell >/dev/null 2>&1 || test -e /usr/share/man/man1/wearwell.1
' || fail 'what was installed does not work'

in_root dpkg --remove wearwell >/mnt/log 2>&1 || { cat /mnt/log; fail 'dpkg cannot remove it'; }
in_root sh -c '! command -v wearwell && ! test -e /usr/lib/wearwell && test -e /var/lib/wearwell/fleet.sqlite && test -e /etc/wearwell/pumps.toml' >/dev/null ||
  fail 'removing it leaves the program, or takes what was stored'
