# Was die Seite für Teilnehmende von sich aus sagt; die Texte einer Studie stehen in deren Datei.

# Seiten, die einen Besuch beenden oder aufhalten
kept = Ihre bisherigen Antworten sind gespeichert oder in diesem Browser aufbewahrt; nach dem Neuladen geht es dort weiter.
reload = Seite neu laden
stopped-title = Die Studie wurde unterbrochen
stopped = Auf dieser Seite ist etwas schiefgegangen. Hilft Neuladen nicht, öffnen Sie den Link bitte in einem anderen Browser.
no-study-title = Diese Studie gibt es nicht
no-study = Bitte prüfen Sie den Link, den Sie bekommen haben, oder fragen Sie die Person, die ihn Ihnen geschickt hat.
finished-title = Diese Studie ist abgeschlossen
finished = Mit diesem Link wurde sie schon abgeschlossen, und teilnehmen kann man einmal. Der Code steht in dem Browser, in dem sie abgeschlossen wurde.
begun-elsewhere-title = Diese Studie ist begonnen
begun-elsewhere = Mit diesem Link wurde sie schon begonnen, und teilnehmen kann man einmal. Bitte machen Sie in dem Browser weiter, in dem sie begonnen wurde.
link-title = Dieser Link kann nicht verwendet werden
link = Was der Link über Sie sagt, kann nicht gespeichert werden. Bitte fragen Sie die Person, die ihn Ihnen geschickt hat, nach einem anderen.
moved-title = In einem anderen Tab fortgesetzt
moved = Sie haben diese Studie in einem anderen Tab oder Fenster fortgesetzt. Dieses hier können Sie schließen.
elsewhere-title = Diese Studie ist in einem anderen Tab geöffnet
elsewhere = Bitte machen Sie dort weiter, oder fahren Sie hier an derselben Stelle fort.
elsewhere-continue = Hier fortfahren
updated-title = Bitte laden Sie diese Seite neu
updated = Diese Studie wurde geändert, seit die Seite geladen wurde; die Seite kann die nächsten Bilder nicht zeigen.
display-title = Dieser Bildschirm kann die nächsten Bilder nicht zeigen
display-other = Bitte öffnen Sie den Link, den Sie bekommen haben, in einem anderen Browser oder auf einem anderen Gerät.

# Einwilligung
consent-title = Ihre Einwilligung
consent-minutes =
    { $minutes ->
        [one] Es dauert ungefähr eine Minute.
       *[other] Es dauert ungefähr { $minutes } Minuten.
    }
consent-print = Diese Seite drucken
consent-decline = Wenn Sie lieber nicht teilnehmen möchten, schließen Sie diese Seite: Es wurde nichts gespeichert.
language-switch = Sprache
consent-agree = Ich willige ein und nehme teil

# Anleitung
instructions-title = So geht es
instructions-start = Beginnen
key-or = oder
kind-two-alternative = Zwei Bilder zugleich
kind-two-interval = Zwei Bilder nacheinander
key-left = linkes Bild
key-right = rechtes Bild
key-first = erstes
key-second = zweites
key-upper = oberes Bild
key-lower = unteres Bild
how-pair-touch = Berühren Sie das Bild, das Sie wählen.
how-pair-click = Klicken Sie auf das Bild, das Sie wählen, oder drücken Sie seine Taste.
how-interval-touch = Berühren Sie die Schaltfläche des Bildes, das Sie wählen.
how-interval-click = Klicken Sie auf die Schaltfläche des Bildes, das Sie wählen, oder drücken Sie seine Taste.

# Durchgänge
position = { $number } von { $all }
position-growing = { $number } von höchstens { $most }
choice-left = Linkes Bild
choice-right = Rechtes Bild
choice-first = Erstes
choice-second = Zweites
spoken-first = Erstes Bild
spoken-second = Zweites Bild
spoken-choose = Bitte wählen Sie: das erste oder das zweite
refresh-unknown = Dieser Browser gibt nicht an, wie oft sein Bildschirm neu gezeichnet wird, und die Bilder dieser Studie sind zeitlich genau bemessen.
refresh-missed = Diese Studie zeigt etwas { $ms } ms lang, und dieser Bildschirm wird nur alle { NUMBER($period_ms, minimumFractionDigits: 1, maximumFractionDigits: 1) } ms neu gezeichnet.

# Warten
pictures-coming = Die Bilder sind unterwegs: { $here } von { $of } sind da ({ NUMBER($mb, minimumFractionDigits: 1, maximumFractionDigits: 1) } MB).
pictures-slow = Die Bilder brauchen länger. Es geht nichts verloren; es geht von selbst weiter.
picture-missing = Im Plan dieser Studie steht ein Bild, das sie nicht hat.
picture-refused = Der Server gibt ein Bild nicht heraus (Status { $status }).
picture-damaged = Ein Bild kam mit anderen Bytes an, als im Plan der Studie steht.
line-down = Keine Verbindung. Es geht nichts verloren: Sobald sie wieder da ist, geht es von selbst weiter.
server-busy = Der Server ist ausgelastet. Es geht nichts verloren: Gleich geht es von selbst weiter.
not-ready = Die Bilder dieser Studie werden gerade hergestellt. Sobald sie da sind, geht es von selbst weiter.
stimuli-failed = Die Bilder dieser Studie konnten nicht hergestellt werden. Sobald sie da sind, geht es von selbst weiter; Sie können auch später wiederkommen.
deciding-title = Einen Moment
deciding = Die nächsten Bilder hängen von Ihren Antworten ab: Sie kommen, sobald diese gespeichert sind.
finishing-title = Fast fertig
finishing = Die Studie endet, sobald Ihre letzten Antworten gespeichert sind.
answers-kept = Keine Verbindung. Ihre Antworten werden hier aufbewahrt und später gesendet; Sie können weitermachen.
answers-kept-waiting = Keine Verbindung. Ihre Antworten werden hier aufbewahrt und später gesendet; sobald die Verbindung wieder da ist, geht es von selbst weiter.
answers-held = Keine Verbindung. Bitte lassen Sie diese Seite geöffnet; Ihre Antworten werden später gesendet.
answers-held-waiting = Keine Verbindung. Bitte lassen Sie diese Seite geöffnet; Ihre Antworten werden später gesendet, und sobald die Verbindung wieder da ist, geht es von selbst weiter.
answers-refused = Eine Antwort konnte noch nicht gespeichert werden. Sie wird hier aufbewahrt; Sie können weitermachen.
answers-refused-waiting = Eine Antwort konnte noch nicht gespeichert werden. Sie wird hier aufbewahrt.
missing-title = Eines fehlt noch
missing =
    { $count ->
        [one] Eine Antwort konnte nicht gespeichert werden; deshalb gibt es noch keinen Code. Es geht nichts verloren: Sie wird in diesem Browser aufbewahrt.
       *[other] { $count } Antworten konnten nicht gespeichert werden; deshalb gibt es noch keinen Code. Es geht nichts verloren: Sie werden in diesem Browser aufbewahrt.
    }
missing-report = Wenn ein neuer Versuch nicht hilft, senden Sie den Forschenden bitte diesen Text: { $reasons } Session { $session }.
try-again = Noch einmal versuchen

# Das Ende
thanks-title = Vielen Dank
code-label = Ihr Abschlusscode
code-stored = Alle Ihre Antworten sind gespeichert. Ihr Abschlusscode:
code-copy = Code kopieren
code-copied = Kopiert
code-select = Bitte markieren Sie den Code und kopieren Sie ihn
about-title = Worum es in dieser Studie geht
return-to = Zurück zu { $host }

# Wessen Besuch es ist
begun-title = Willkommen zurück
begun = Diese Studie wurde in diesem Browser begonnen und ist noch nicht beendet.
begun-continue = Ich habe sie begonnen: weiter
someone-else = Ich bin jemand anderes
someone-else-note = Wenn es jemand anderes war, beginnen Sie neu: Die bisherigen Antworten bleiben der anderen Person.
next-person = Zurück zum Anfang, für die nächste Person
gone-title = Diese Sitzung ist beendet
gone = Der Server kennt diese Sitzung nicht mehr. Bitte laden Sie die Seite neu, um von vorn zu beginnen, oder sagen Sie es der Person, die Ihnen den Link geschickt hat.
answer-other = Sie waren lange weg, und inzwischen sind andere Bilder für Sie vorgesehen. Bitte wählen Sie erneut.

# Netze und alte Browser
line-foreign = Etwas zwischen diesem Browser und der Studie antwortet an ihrer Stelle, etwa die Anmeldeseite eines Netzes. Nichts geht verloren: Diese Seite macht von selbst weiter, sobald es weg ist.
answer-again = Eine Antwort konnte nicht gespeichert werden, deshalb sind ihre Bilder noch einmal da. Bitte wählen Sie erneut.
pictures-again = Ein Bild kam beschädigt an, deshalb sind diese Bilder noch einmal da. Bitte wählen Sie erneut.
too-old = Dieser Browser ist zu alt für diese Studie. Bitte öffnen Sie den Link in einem neueren: { $browsers } oder später.
not-loaded = Diese Seite konnte nicht vollständig geladen werden. Bitte prüfen Sie die Verbindung und laden Sie sie neu.
no-script = Diese Studie braucht JavaScript. Bitte schalten Sie es für diese Seite ein, oder öffnen Sie den Link in einem anderen Browser.

# Eine Studie ausprobieren
trying-preview = Vorschau: Nichts wird gespeichert.
trying-pilot = Probelauf: Antworten werden gespeichert und in keiner Auswertung gezählt.
trying-restart = Von vorn beginnen
